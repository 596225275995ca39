"""A run in steps is the run in one piece, whatever is set on the way."""

from __future__ import annotations

import copy
import itertools
import pickle
from collections.abc import Callable

import numpy as np
import pytest

import clutchwork as cw
from support import six_speed
from support.amount import seeds
from support.random_drivelines import T_END, describe, sequence

# tight enough that what the pieces of a run cut from steps of the solver is small beside what is compared
TIGHT = {"rtol": 1e-9, "atol": 1e-11}
# of the largest speed or torque; two runs of other steps may each be wrong by a few hundred times rtol
CLOSE = 1e-6
CASES = max(4, len(seeds()) // 12)


def pieces(rng: np.random.Generator, end: float, count: int) -> list[float]:
    """Random instants up to an end."""
    return [*np.sort(rng.uniform(0.0, end, count)).tolist(), end]


def told(events: cw.Events) -> list[tuple[str, str]]:
    """What happened, in order."""
    return sequence([(event.time, event.element, event.after) for event in events.changes()])


def close(got: np.ndarray, wanted: np.ndarray) -> None:
    assert np.max(np.abs(got - wanted)) <= CLOSE * max(1.0, np.max(np.abs(wanted)))


def speeds(run: cw.Trajectory) -> np.ndarray:
    return np.array([run[name] for name in run.names if name.endswith(".speed")])


@pytest.mark.parametrize("seed", range(CASES))
def test_random_pieces_are_the_run_in_one(seed: int) -> None:
    rng, system = np.random.default_rng(seed), describe(seed).driveline().assemble()
    whole = cw.simulate(system, T_END, **TIGHT)
    sim = cw.Simulator(system, **TIGHT)
    for stop in pieces(rng, T_END, 40):
        sim.advance_to(stop)
        assert sim.time == stop
    assert told(sim.events) == told(whole.events)
    run, times = sim.run, np.linspace(0.0, T_END, 21)
    close(speeds(run.at(times)), speeds(whole.at(times)))
    assert run.finished
    assert run.t_end == T_END
    assert sim.events == run.events
    # both are balances of the same integrals
    assert abs(run.energy.residual) <= 1e-6 * run.energy.turnover
    assert run.energy.input == pytest.approx(whole.energy.input, rel=1e-5, abs=1e-5 * whole.energy.turnover)


@pytest.mark.parametrize("seed", range(CASES))
def test_what_is_set_is_the_step_of_a_table(seed: int) -> None:
    rng, model = np.random.default_rng(seed), describe(seed)
    instants = pieces(rng, T_END, 8)[:-1]
    system, chosen = model.driveline().assemble(), f"c{seed % len(model.clutches)}.pressure"
    before, values = model.clutches[seed % len(model.clutches)].pressure, rng.uniform(0.0, 1e6, len(instants)).tolist()
    at = [x for x, _ in before]
    left = float(np.interp(instants[0], at, [y for _, y in before]))
    points = [(x, y) for x, y in before if x < instants[0]] + [(instants[0], left)]
    for first, last, value in zip(instants, [*instants[1:], T_END], values, strict=True):
        points += [(first, value), (last, value)]
    points = points if points[0][0] <= 0.0 else [(0.0, points[0][1]), *points]
    whole = cw.simulate(system.changed({chosen: cw.Table(points)}), T_END, **TIGHT)
    sim = cw.Simulator(system, **TIGHT)
    for stop, value in zip(instants, values, strict=True):
        sim.advance_to(stop)
        sim.set(chosen, value)
        assert sim[chosen] == value
    sim.advance_to(T_END)
    assert told(sim.events) == told(whole.events)
    times = np.linspace(0.0, T_END, 21)
    close(speeds(sim.run.at(times)), speeds(whole.at(times)))
    close(sim.run.at(times)[chosen], whole.at(times)[chosen])


def rising() -> cw.Driveline:
    """A clutch whose pressure follows a table, and a torque that is a sine."""
    d = cw.Driveline("rising")
    a, b = d.shaft("a", inertia=1.0, speed=100.0), d.shaft("b", inertia=2.0)
    friction = cw.Coulomb(static=0.3, kinetic=0.25)
    pressure = cw.Table([(0.0, 0.0), (0.5, 2e5), (1.0, 0.0), (1.5, 4e5)])
    d.add(cw.Clutch("c", base=a, follower=b, friction=friction, gain=1e-3, pressure=pressure))
    d.add(cw.Torque("m", shaft=a, torque=cw.Sine(amplitude=20.0, frequency=3.0)))
    d.add(cw.Brake("hold", shaft=b, friction=friction, gain=1e-3, pressure=0.0))
    return d


def test_a_signal_is_followed_until_it_is_set_and_after_it_is_released() -> None:
    d, sim = rising(), cw.Simulator(rising(), **TIGHT)
    whole = d.simulate(1.5, times=[0.25, 0.75, 1.25, 1.5])
    wanted = whole["c.pressure"]
    for stop, value in zip((0.25, 0.75), wanted, strict=False):
        sim.advance_to(stop)
        assert sim["c.pressure"] == value
    sim.set("c.pressure", 1e5)
    sim.set("m.torque", -3.0)
    sim.advance_to(1.0)
    assert (sim["c.pressure"], sim["m.torque_signal"] if "m.torque_signal" in sim else sim["m.torque"]) == (1e5, -3.0)
    assert sim.held == {"c.pressure": 1e5, "m.torque": -3.0}
    sim.release("c.pressure")
    assert sim.held == {"m.torque": -3.0}
    sim.advance_to(1.25)
    assert sim["c.pressure"] == pytest.approx(wanted[2], rel=1e-12)
    sim.release()
    assert sim.held == {}
    with pytest.raises(cw.UseError, match=r"'c.pressure' is not set; set is nothing"):
        sim.release("c.pressure")


def test_a_released_signal_that_repeats_is_in_step() -> None:
    d = cw.Driveline("pulses")
    d.add(cw.Torque("m", shaft=d.shaft("a", inertia=1.0), torque=cw.Pulse(height=2.0, period=0.1, width=0.03)))
    wanted, sim = d.simulate(1.0, dt=0.013), cw.Simulator(d)
    sim.set("m.torque", 5.0)
    sim.advance_to(0.52)
    sim.release("m.torque")
    for time, value in zip(wanted.time, wanted["m.torque"], strict=True):
        if time > 0.52:
            sim.advance_to(time)
            assert sim["m.torque"] == value


def test_reading_changes_nothing() -> None:
    """Whether and how often a run is read leaves no trace, on shafts without inertia either."""
    for model in (describe(3).driveline(), massless(), rising()):
        ends = []
        for reads in (False, True):
            sim, seen = cw.Simulator(model), list[bytes]()
            name = next(name for name in sim.names if name.endswith(".pressure"))
            for k in range(40):
                if k % 3 == 0:
                    sim.set(name, 1e5 * (k % 7))
                if reads:
                    assert np.isfinite(sim[[one for one in sim.names if not one.endswith(".state")]]).all()
                    assert len(sim.events) >= 0
                sim.advance(0.01)
                seen.append(sim.save().row)
            ends.append(seen)
        assert ends[0] == ends[1]


def massless() -> cw.Driveline:
    """A shaft without inertia between a spring and a damper, and a clutch behind it."""
    d = cw.Driveline("massless")
    a, between, b = d.shaft("a", inertia=1.0, speed=50.0), d.shaft("between"), d.shaft("b", inertia=0.5)
    d.add(cw.SpringDamper("k", base=a, follower=between, stiffness=400.0, damping=0.7))
    d.add(cw.Damper("d", base=between, follower=b, damping=3.0))
    friction = cw.Coulomb(static=0.3, kinetic=0.25)
    d.add(cw.Brake("brake", shaft=b, friction=friction, gain=1e-3, pressure=cw.Table([(0.0, 0.0), (0.3, 3e5)])))
    return d


def test_durations_add_up_without_round_off() -> None:
    sim = cw.Simulator(rising())
    for k in range(100):
        sim.advance(0.01)
        assert sim.time == float(f"{k + 1}e-2")
    assert sim.time == 1.0
    sim.advance(0.0)
    assert sim.time == 1.0
    sim.advance("10 ms")
    assert sim.time == 1.01


@pytest.mark.parametrize("step", [0.002, 0.0047, 0.01, 0.25])
def test_controllers_of_the_model_act_at_their_instants(step: float) -> None:
    """Whether a step ends between their instants, on them, or beyond several of them."""
    calls = list[float]()

    def law(time: float, readings: cw.System) -> float:
        calls.append(time)
        return 1e5 * (1 + time) + 300.0 * abs(readings["c.slip"])

    def model() -> cw.Driveline:
        d = rising()
        return d.assemble().changed({"c.pressure": cw.Sampled(law, 0.01), "hold.pressure": cw.Sampled(law, 0.025)})

    whole = cw.simulate(model(), 1.0, **TIGHT)
    wanted, calls[:] = list(calls), []
    sim = cw.Simulator(model(), **TIGHT)
    while sim.time < 1.0:
        sim.advance_to(min(1.0, sim.time + step))
    assert calls == wanted
    calls.clear()
    run = sim.run
    assert calls == []
    times = np.linspace(0.0, 1.0, 21)
    close(speeds(run.at(times)), speeds(whole.at(times)))
    assert told(run.events) == told(whole.events)


def test_a_controller_is_silent_while_its_signal_is_set() -> None:
    calls = list[float]()

    def law(time: float, readings: object) -> float:
        calls.append(time)
        return 1e5

    sim = cw.Simulator(rising().assemble().changed({"c.pressure": cw.Sampled(law, 0.01)}))
    sim.advance_to(0.1)
    sim.set("c.pressure", 3e5)
    sim.advance_to(0.2)
    assert sim["c.pressure"] == 3e5
    state = sim.save()
    sim.release("c.pressure")
    sim.advance_to(0.3)
    assert sim["c.pressure"] == 1e5
    assert np.allclose(calls, [0.01 * k for k in (*range(10), *range(20, 30))])
    calls.clear()
    sim.restore(state)
    sim.advance_to(0.3)
    assert (sim["c.pressure"], calls) == (3e5, [])


def test_a_controller_that_fails_says_so_at_once_and_for_good() -> None:
    def law(time: float, readings: object) -> float:
        if time > 0.05:
            raise ZeroDivisionError("no")
        return 1e5

    sim = cw.Simulator(rising().assemble().changed({"c.pressure": cw.Sampled(law, 0.01)}))
    with pytest.raises(cw.SimulationError, match=r"controller of 'c.pressure' failed at 0.06 s") as caught:
        sim.advance(1.0)
    assert caught.value.trajectory is not None
    assert caught.value.trajectory.time[-1] == pytest.approx(0.06)
    for again in (lambda: sim.advance(0.01), sim.save, lambda: sim.advance_to(2.0)):
        with pytest.raises(cw.SimulationError, match=r"controller of 'c.pressure' failed"):
            again()
    sim.reset()
    sim.advance(0.05)
    assert sim.time == 0.05


def jumping() -> cw.Driveline:
    """A law that jumps with the sign of the slip: at rest it chatters."""
    d = cw.Driveline("chatter")
    a = d.shaft("a", inertia=1.0, speed=1.0)
    d.add(
        cw.Brake("c", shaft=a, friction=cw.NaiveSign(static=0.3, kinetic=0.3, speed=1.0), gain=1.0, normal_force=30.0)
    )
    return d


def stepped(sim: cw.Simulator, count: int) -> None:
    for _ in range(count):
        sim.advance(0.01)


def test_a_run_that_stops_early_says_so_at_once() -> None:
    sim = cw.Simulator(jumping())
    with pytest.warns(cw.StoppedEarly):
        whole = jumping().simulate(1.0)
    with pytest.raises(cw.SimulationError, match="cannot come to rest") as caught:
        stepped(sim, 100)
    run = caught.value.trajectory
    assert run is not None
    assert run.status == whole.status == "chatter"
    assert not run.finished
    assert run.time[-1] == pytest.approx(whole.time[-1], abs=1e-3)
    assert run is sim.run
    assert len(run.events) == len(sim.run.events)
    with pytest.raises(cw.SimulationError, match="cannot come to rest"):
        sim.advance(0.01)
    for again in (
        lambda: sim["a.speed"],
        lambda: sim.set("c.normal_force", 0.0),
        lambda: sim.set({"c.gain": 2.0}),
    ):
        with pytest.raises(cw.SimulationError, match="cannot come to rest"):
            again()
    assert sim.held == {}
    sim.reset()
    sim.set("c.normal_force", 0.0)
    sim.advance(1.0)
    assert sim["a.speed"] == 1.0


def test_budgets_count_from_where_the_simulator_begins() -> None:
    sim = cw.Simulator(rising(), max_steps=60)
    with pytest.raises(cw.SimulationError, match="budget of steps"):
        sim.advance(10.0)
    sim.reset()
    sim.advance(0.1)
    after = cw.simulate(rising(), 0.3, start=sim.save(), max_steps=60)
    assert after.finished
    assert after.statistics["steps"] < 60


def test_faults_are_told_where_they_happen() -> None:
    d = cw.Driveline("fault")
    a, b = d.shaft("a", inertia=1.0, speed=50.0), d.shaft("b", inertia=1.0)
    friction = cw.Coulomb(static=0.3, kinetic=0.25)
    clutch = cw.DiskClutch(
        "c",
        base=a,
        follower=b,
        radius=0.1,
        area=1e-3,
        pressure=1e5,
        friction=friction,
        fault="cannot_transmit",
        fault_time=0.3,
    )
    d.add(clutch)
    sim = cw.Simulator(d)
    sim.advance_to(0.25)
    with pytest.warns(cw.FaultWarning, match=r"'c' cannot transmit .* 0.3 s"):
        sim.advance_to(0.5)


def test_a_closed_loop_shift_has_the_same_bits_after_a_break() -> None:
    """Six-speed gearbox, controller outside at 10 ms, saved and restored in the middle: here and elsewhere."""
    model = six_speed.gearbox(six_speed.SHIFT, {"w1": 35.0, "w2": 0.0, "w4": 0.0, "w8": 0.0})

    def shift(sim: cw.Simulator, last: int, memory: list[float]) -> list[float]:
        seen = list[float]()
        while sim.time < 0.01 * last - 1e-9:
            slip = sim["F1.slip"]
            memory[0] += 0.01 * slip
            wanted = 2e5 * max(0.0, sim.time - 1.0) + 10.0 * max(0.0, slip) + 5.0 * max(0.0, memory[0])
            sim.set({"F1.pressure": wanted, "F2.pressure": 2e6 * min(1.0, max(0.0, 1.2 - sim.time) * 5.0)})
            sim.advance(0.01)
            seen += [*sim._readout.rows[0].tolist()]
        return seen

    whole, memory = cw.Simulator(model), [0.0]
    seen = shift(whole, 300, memory)
    broken, memory = cw.Simulator(model), [0.0]
    first = shift(broken, 130, memory)
    state, kept = broken.save(), list(memory)
    shift(broken, 180, memory)
    broken.restore(state)
    elsewhere = cw.Simulator(model, start=state)
    for sim in (broken, elsewhere):
        assert first + shift(sim, 300, list(kept)) == seen
    assert broken.events == whole.events
    assert np.array_equal(broken.run.rows, whole.run.rows)
    assert np.array_equal(broken.run.time, whole.run.time)
    # it did shift
    assert {"F1", "F2"} <= {event.element for event in whole.events.changes()}


def test_a_run_of_steps_has_all_that_a_run_has(tmp_path) -> None:
    sim = cw.Simulator(rising())
    with pytest.raises(ValueError, match="work=True"):
        _ = cw.Simulator(rising(), work=False).run.energy
    for k in range(150):
        sim.set("hold.pressure", 1e4 * (k // 50))
        sim.advance(0.01)
    run = sim.run
    assert run["a.speed"][-1] == sim["a.speed"]
    assert run.names == sim.names
    assert run.units == sim.units
    assert run.at([0.2, 0.7]).time.tolist() == [0.2, 0.7]
    assert abs(run.energy.residual) < 1e-5 * run.energy.turnover
    run.to_csv(tmp_path / "run.csv", ["a.speed"])
    assert (tmp_path / "run.csv").read_text().splitlines()[0] == "time [s],a.speed [rad/s]"
    assert len(run.to_pandas(["a.speed"])) == len(run)
    assert run.plot(tmp_path / "run.png") is not None
    again = run.at(run.time)
    assert np.array_equal(again.rows, run.rows)
    # a trajectory stays what it was when the simulator goes on
    sim.set("c.pressure", 0.0)
    sim.advance(0.1)
    assert np.array_equal(run.at(run.time).rows, again.rows)
    assert sim.run.t_end > run.t_end


def test_a_trajectory_is_that_of_the_steps_bit_for_bit() -> None:
    for model in (rising(), massless(), describe(1).driveline()):
        sim, instants, rows = cw.Simulator(model), list[float](), list[np.ndarray]()
        for k in range(60):
            if k % 9 == 4:
                sim.set(next(name for name in sim.names if name.endswith(".pressure")), 2e4 * k)
            sim.advance(0.017)
            instants.append(sim.time)
            rows.append(sim._readout.rows[0].copy())
        found = sim.run.at(instants)
        assert np.array_equal(found.rows[-1], rows[-1])
        if not np.any(found.system.arrays["massless"]):
            assert np.array_equal(found.rows, np.array(rows))


def test_knots_at_the_end_of_a_step_wait_for_what_is_set() -> None:
    """A table that opens a clutch there does not, where it is set at the same instant."""
    d = rising()
    model = d.assemble().changed({"c.pressure": cw.Table([(0.0, 4e5), (1.0, 4e5), (1.0, 0.0), (2.0, 0.0)])})
    sim = cw.Simulator(model)
    sim.advance_to(1.0)
    assert sim["c.state"] == "locked"
    assert sim["c.pressure"] == 4e5
    sim.set("c.pressure", 3e5)
    assert sim["c.state"] == "locked"
    sim.advance_to(1.2)
    assert all(event.time < 1.0 for event in sim.events.changes())
    assert sim.run.events == sim.events


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda sim: sim.advance(-0.1), "it must not be negative"),
        (lambda sim: sim.advance("1 m"), "duration is '1 m': give a number in s"),
        (lambda sim: sim.advance(float("nan")), "give a number in s"),
        (lambda sim: sim.advance_to(0.01), r"time is 0.01 s, before the present time 0.1 s; sim.restore"),
        (lambda sim: sim.advance(), "duration is missing"),
        (lambda sim: sim.restore(3), "state is 3: give what sim.save"),
        (lambda sim: sim.set("c.pressure"), r"'c.pressure' has no value; write sim.set\('c.pressure', value\)"),
        (lambda sim: sim.set(), "name is missing"),
        (lambda sim: sim.release("c.pressure"), "'c.pressure' is not set"),
    ],
)
def test_wrong_calls_are_told(call: Callable[[cw.Simulator], None], words: str) -> None:
    sim = cw.Simulator(rising())
    sim.advance(0.1)
    with pytest.raises(cw.UseError, match=words):
        call(sim)
    assert sim.time == 0.1


@pytest.mark.parametrize(
    ("fields", "error", "words"),
    [
        ({"t_end": 1.0}, cw.OptionError, "t_end cannot be given to a Simulator: sim.advance says how far"),
        ({"times": [0.0]}, cw.OptionError, "times cannot be given to a Simulator: ask sim.run.at"),
        ({"rtoll": 1.0}, cw.UseError, "did you mean 'rtol'"),
        ({"options": 3}, cw.UseError, r"it must be cw.Options\(...\)"),
        ({"start": 3}, cw.UseError, "start is 3"),
        ({"t_start": -1.0}, cw.OptionError, "t_start is -1 s"),
    ],
)
def test_wrong_options_are_told(fields: dict[str, object], error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        cw.Simulator(rising(), **fields)
    with pytest.raises(cw.UseError, match="is not a model; load a file"):
        cw.Simulator("model.toml")


def test_copies_go_by_way_of_a_state() -> None:
    sim = cw.Simulator(rising())
    sim.advance(0.2)
    for make in (copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(cw.UseError, match=r"start with cw.Simulator\(model, start=state\)"):
            make(sim)
    run = pickle.loads(pickle.dumps(sim.run))
    assert np.array_equal(run.at([0.1, 0.2]).rows, sim.run.at([0.1, 0.2]).rows)
    assert run.state().row == sim.save().row


def test_unknown_signals_have_near_names() -> None:
    sim = cw.Simulator(rising())
    with pytest.raises(KeyError, match=r"did you mean 'a.speed'"):
        sim["a.sped"]
    assert "a.speed" in sim
    assert "a.sped" not in sim
    assert list(itertools.islice(sim, 2)) == list(sim.names[:2])
