"""States continue with the same bits, wherever they are continued; damaged ones and those of others are refused."""

from __future__ import annotations

import pickle
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import seeds
from support.any_model import agree, model
from support.continued import brake, same
from support.random_contacts import driveline as random_contacts
from support.random_drivelines import T_END, describe

ROOT = Path(__file__).resolve().parents[2]
MODELS = sorted((ROOT / "examples").glob("*/model.toml"))
CASES = max(4, len(seeds()) // 12)
STEPS = {"output": "steps"}


@pytest.mark.parametrize("seed", range(9200, 9200 + 2 * CASES))
def test_a_closed_loop_goes_on_as_from_its_states(seed: int) -> None:
    """What one call leaves for the next is nothing but time: rows and events are those of a run that is put there."""
    rng = np.random.default_rng(seed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        system = cw.Driveline.from_dict(model.model(seed)).assemble()
        try:
            goes_on, anew = cw.Simulator(system), cw.Simulator(system)
            names = [name for name, unit in goes_on.units.items() if unit]
            inputs = [item.name for item in system.inputs if item.name in names and not item.signal.sampling()]
            goes_on.advance(1e-3)
            for _ in range(12):
                anew.restore(goes_on.save())
                before = len(goes_on.events)
                for name in inputs[: int(rng.integers(0, 3))]:
                    value = goes_on[name] * rng.uniform(0.8, 1.2)
                    goes_on.set(name, value)
                    anew.set(name, value)
                goes_on.advance(2e-3)
                anew.advance(2e-3)
                assert [goes_on[name] for name in names] == [anew[name] for name in names]
                assert list(goes_on.events)[before:] == list(anew.events)
        except (cw.SimulationError, cw.ModelError, cw.UseError):
            pytest.skip("a model that cannot be stepped")


def tail(run: cw.Trajectory, begin: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and rows of a run after an instant."""
    later = run.time > begin
    return run.time[later], run.rows[later]


@pytest.mark.parametrize("seed", range(CASES))
def test_all_continuations_have_the_same_bits(seed: int, tmp_path: Path) -> None:
    rng, system = np.random.default_rng(seed), describe(seed).driveline().assemble()
    at = float(rng.uniform(0.1, 1.8))
    whole = cw.simulate(system, T_END, **STEPS)
    state = whole.state(at)
    assert state.time == at
    state.save(tmp_path / "a.state")
    states = [state, pickle.loads(pickle.dumps(state)), cw.State.load(tmp_path / "a.state"), whole.state(at)]
    runs = [cw.simulate(system, T_END, start=one, **STEPS) for one in states]
    for run in runs[1:]:
        same(run, runs[0])
    run = runs[0]
    assert run.time[0] == at
    assert run.time[-1] == T_END
    # the step that was cut there makes it another run within the tolerance: errors of a lock-up add up
    assert np.allclose(run.rows[-1], whole.rows[-1], rtol=1e-3, atol=1e-3 * np.max(np.abs(whole.rows)))
    sim = cw.Simulator(system, start=state)
    sim.advance_to(T_END)
    assert sim.save().row == run.rows[-1].tobytes()
    # where a step of the solver ends, it is the same run
    place = int(rng.integers(1, len(whole) - 1))
    instant = float(whole.time[place])
    later = cw.simulate(system, T_END, start=whole.state(instant), **STEPS)
    for mine, theirs in zip(tail(later, instant), tail(whole, instant), strict=True):
        assert mine.tobytes() == theirs.tobytes()
    assert later.events[:] == cw.Events([event for event in whole.events if event.time > instant])


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seed", seeds(12))
def test_a_state_at_an_event_is_what_follows_it(seed: int) -> None:
    """Its first row is the right limit, and what has happened does not happen again."""
    made = model.model(9000 + seed)
    run = agree.run(made)
    begin = made["simulation"].get("t_start", 0.0)
    for time in sorted({e.time for e in run.events if begin < e.time < run.time[-1]})[:4]:
        row = int(np.searchsorted(run.time, time, side="right")) - 1
        further = model.driveline(made).simulate(run.t_end, start=run.state(at=time))
        assert [e.element for e in further.events if e.time == time] == []
        for name in run.names:
            here, there = run[name][row], further[name][0]
            if run[name].dtype.kind == "f":
                assert there == pytest.approx(here, rel=1e-6, abs=1e-6), name
            else:
                assert there == here, name


def test_a_state_where_a_slip_turns_has_turned() -> None:
    d = cw.Driveline("band brake")
    s1, s2 = (d.shaft(name, inertia=1.0) for name in ("s1", "s2"))
    d.add(cw.TorqueLimiter("limiter", base=s1, follower=s2, torque=10.0))
    d.add(cw.Torque("drive", shaft=s1, torque=cw.Table([(0.0, 5.0), (0.125, -10.0)])))
    pads = cw.Coulomb(static=0.25, kinetic=0.25)
    d.add(cw.BandBrake("band", shaft=s1, friction=pads, radius=0.1, wrap=4.0, force=10.0))
    d.add(cw.QuadraticTorque("fan", shaft=s2, nominal_torque=-10.0, nominal_speed=50.0))
    run = d.simulate(0.5)
    (turn,) = [e.time for e in run.events if e.cause == "slip zero" and e.after == "backward"]
    further = d.simulate(0.5, start=run.state(at=turn))
    assert further["band.state"][0] == "backward"
    assert all(e.time > turn for e in further.events)


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.parent.name)
def test_examples_go_on_from_any_instant(path: Path) -> None:
    d = cw.Driveline.load(path)
    whole = d.simulate(**STEPS)
    for share in (0.0, 0.3, 0.77, 1.0):
        instant = float(whole.time[round(share * (len(whole) - 1))])
        state = whole.state(instant)
        if instant == whole.t_end:
            assert state.row == whole.rows[-1].tobytes() == whole.state().row
            continue
        run = d.simulate(start=state, **STEPS)
        for mine, theirs in zip(tail(run, instant), tail(whole, instant), strict=True):
            assert mine.tobytes() == theirs.tobytes()
        between = instant + 0.4 * (whole.t_end - instant)
        cut = d.simulate(start=run.state(between))
        assert cut.time[0] == between
        assert cut.finished
        assert abs(cut.energy.residual) <= 1e-4 * max(1.0, cut.energy.turnover)
        same(cut, d.simulate(start=run.state(between)))


CONTINUE = """
import sys
import clutchwork as cw
sim = cw.Simulator(cw.Driveline.load(sys.argv[1]), start=cw.State.load(sys.argv[2]))
assert sim.held == {"F1.pressure": 3e5, "F2.gain": 0.08}, sim.held
for k in range(20):
    sim.set("F1.pressure", 3e5 + 1e4 * k)
    sim.advance(0.01)
sim.release("F2.gain")
sim.advance(0.1)
sim.save().save(sys.argv[3])
"""


def test_another_process_continues_with_the_same_bits(tmp_path: Path) -> None:
    path, here, there = ROOT / "examples/six_speed/model.toml", tmp_path / "here", tmp_path / "there"
    sim = cw.Simulator(cw.Driveline.load(path))
    sim.advance(2.2)
    sim.set({"F1.pressure": 3e5, "F2.gain": 0.08})
    sim.save().save(here)
    for k in range(20):
        sim.set("F1.pressure", 3e5 + 1e4 * k)
        sim.advance(0.01)
    sim.release("F2.gain")
    sim.advance(0.1)
    subprocess.run([sys.executable, "-c", CONTINUE, str(path), str(here), str(there)], check=True)
    other, mine = cw.State.load(there), sim.save()
    assert (other.time, other.row) == (mine.time, mine.row)
    assert other.held == mine.held == {"F1.pressure": 4.9e5}
    assert other.changed == mine.changed == {}


def test_a_run_may_begin_later() -> None:
    """Signals are those of that time; the speeds are those of the model."""
    run = brake().simulate(1.0, t_start=0.5, rtol=1e-10)
    assert run.time[0] == 0.5
    assert run["a.speed"][0] == 100.0
    assert run["b.pressure"][0] == 1e5
    # deceleration 25 rad/s2 for 0.1 s, then 50 rad/s2
    assert run.at([0.6, 1.0])["a.speed"] == pytest.approx([97.5, 77.5], rel=1e-9)
    assert run.energy.heat["b"] == pytest.approx(0.5 * (100.0**2 - 77.5**2), rel=1e-8)
    assert abs(run.energy.residual) < 1e-8 * run.energy.turnover
    assert brake().simulate(1.0, t_start=0.5, dt=0.2).time.tolist() == pytest.approx([0.5, 0.7, 0.9, 1.0])
    assert "0.5 to 1 s" in repr(run)
    # both limits of the jump, and none before the begin
    assert np.count_nonzero(run.time == 0.6) == 2
    sim = cw.Simulator(brake(), t_start=0.5, rtol=1e-10)
    assert sim.time == 0.5
    sim.advance(0.1)
    assert sim.time == 0.6
    assert sim["a.speed"] == pytest.approx(97.5, rel=1e-9)
    sim.reset()
    assert (sim.time, sim["a.speed"]) == (0.5, 100.0)


@pytest.mark.parametrize("order", ["ab", "ba"])
@pytest.mark.parametrize("given", ["a", "b", ""])
def test_speeds_that_nobody_gave_follow_what_is_prescribed_at_a_later_start(order: str, given: str) -> None:
    """b is faster than a by what is prescribed then, c follows from both; without a given speed the first one rests."""
    d = cw.Driveline("later")
    shafts = {name: d.shaft(name, inertia=1.0, **({"speed": 5.0} if name == given else {})) for name in (*order, "c")}
    faster = cw.Table([(0.0, 1.0), (0.5, 4.0), (1.0, 4.0)])
    d.add(cw.PrescribedSpeed("pull", base=shafts["a"], shaft=shafts["b"], speed=faster))
    d.add(cw.Planetary("gear", sun=shafts["a"], ring=shafts["b"], carrier=shafts["c"], ratio=2.0))
    run = d.simulate(1.0, t_start=0.5)
    a = 5.0 - 4.0 * (given == "b") if given else -4.0 * (order == "ba")
    speeds = [run[f"{name}.speed"][0] for name in "abc"]
    assert speeds == pytest.approx([a, a + 4.0, a + 8.0 / 3.0], abs=1e-14)
    assert not run.events.at_start()


def test_speeds_follow_a_ratio_at_a_later_start() -> None:
    """A chain of two transmissions: the shaft with a given speed keeps it, no impulse is shared out."""
    d = cw.Driveline("ratios")
    a, b, c = d.shaft("a", inertia=1.0), d.shaft("b", inertia=2.0, speed=6.0), d.shaft("c", inertia=3.0)
    d.add(cw.VariableGear("one", input=a, output=b, ratio=cw.Table([(0.0, 1.0), (0.5, 3.0), (1.0, 3.0)])))
    d.add(cw.VariableGear("two", input=b, output=c, ratio=cw.Table([(0.0, 2.0), (0.5, -4.0), (1.0, -4.0)])))
    run = d.simulate(1.0, t_start=0.5)
    assert [run[f"{name}.speed"][0] for name in "abc"] == pytest.approx([18.0, 6.0, -1.5], rel=1e-14)


@pytest.mark.parametrize("kind", ["zero beside the housing", "both given", "parallel", "singular"])
def test_a_ratio_that_contradicts_given_speeds_at_a_later_start_jams(kind: str) -> None:
    """At 0 s all fit; no impulse takes what was given."""
    d = cw.Driveline("contradicted")
    a = d.shaft("a", inertia=0.5, **({} if kind in ("parallel", "singular") else {"speed": 5.0}))
    b = d.shaft("b", inertia=0.5, **({} if kind == "singular" else {"speed": 5.0}))
    first = 0.0 if kind == "zero beside the housing" else 1.0

    def gear(name: str, front: Any, then: float) -> None:
        ratio = cw.Table([(0.0, first), (0.5, then), (1.0, then)])
        d.add(cw.VariableGear(name, input=front, output=b, ratio=ratio))

    gear("one", d.housing if first == 0.0 else a, -2.0 if kind == "singular" else 2.0)
    if kind == "parallel":
        gear("two", a, 3.0)
    if kind == "singular":
        d.add(cw.Planetary("set", sun=a, ring=b, carrier=d.shaft("c", inertia=0.5, speed=5.0), ratio=2.0))
    with pytest.warns(cw.StoppedEarly, match="locked contacts break the ratio of a transmission at '"):
        run = d.simulate(1.0, t_start=0.5)
    assert run.status == "jammed"


def test_a_run_that_is_left_between_steps_has_the_same_bits() -> None:
    """The slip that counts as zero is that of the last event, also where rows or a state are asked for in between."""
    d = cw.Driveline("parting")
    fast, slow = d.shaft("fast", inertia=0.01), d.shaft("slow")
    gently = cw.Sine(amplitude=1e-4, frequency=0.1, phase=-0.5 * np.pi, offset=1e-4)
    d.add(cw.Spring("spring", base=fast, follower=d.housing, stiffness=1.0, initial_twist=1.0))
    d.add(cw.PrescribedSpeed("pull", shaft=slow, speed=gently))
    d.add(cw.TorqueLimiter("limiter", base=d.housing, follower=slow, torque=1.0))
    whole = d.simulate(0.3, **STEPS)
    instant = next(event.time for event in whole.events if event.cause == "torque limit")
    before = whole.time[whole.time < instant]
    for at in before[1:].tolist():
        run = d.simulate(0.3, start=whole.state(at), **STEPS)
        for mine, theirs in zip(tail(run, at), tail(whole, at), strict=True):
            assert mine.tobytes() == theirs.tobytes()


def test_a_repeated_signal_is_in_step_wherever_a_run_begins() -> None:
    d = cw.Driveline("pulses")
    d.add(cw.Torque("m", shaft=d.shaft("a", inertia=1.0), torque=cw.Pulse(height=2.0, period=0.1, width=0.03)))
    whole, late = d.simulate(2.0, dt=0.01), d.simulate(2.0, t_start=1.0, dt=0.01)
    assert late["m.torque"][1:].tolist() == whole["m.torque"][101:].tolist()
    smooth = d.simulate(1.5, t_start=1.02)
    assert smooth.time[0] == 1.02
    assert np.all(np.diff(smooth.time) >= 0.0)
    assert sum(smooth.time == 1.1) == 2


def test_impulses_of_a_later_start_are_those_of_a_start() -> None:
    """Two shafts that are locked at other speeds: the impulse takes out energy, which the balance counts as heat."""
    d = cw.Driveline("impulse")
    a, b = d.shaft("a", inertia=1.0, speed=10.0), d.shaft("b", inertia=1.0, speed=0.0)
    d.add(
        cw.Clutch(
            "c", base=a, follower=b, friction=cw.Coulomb(static=0.3, kinetic=0.25), gain=1.0, pressure=1e4, locked=True
        )
    )
    first, later = d.simulate(1.0), d.simulate(3.0, t_start=2.0)
    assert later.energy.impulses == first.energy.impulses == pytest.approx(25.0)
    assert later.events.at_start()[0].time == 2.0
    assert abs(later.energy.residual) < 1e-9
    after = d.simulate(4.0, start=later.state())
    assert after.energy.impulses == 0.0
    assert abs(after.energy.residual) < 1e-9


def test_controllers_go_on_from_a_state() -> None:
    def law(time: float, readings: dict[str, float]) -> float:
        return 1e5 * (1.0 + time) + readings["a.speed"]

    system = brake().assemble().changed({"b.pressure": cw.Sampled(law, 0.01)})
    whole = cw.simulate(system, 1.0, **STEPS)
    for at in (0.5, 0.37):
        run = cw.simulate(system, 1.0, start=whole.state(at), **STEPS)
        for mine, theirs in zip(tail(run, at), tail(whole, at), strict=True):
            assert mine.tobytes() == theirs.tobytes()


def test_a_simulator_goes_back_and_keeps_its_past() -> None:
    sim = cw.Simulator(brake())
    sim.advance(0.3)
    state = sim.save()
    whole = []
    for pressure in (0.0, 5e5):
        sim.set("b.pressure", pressure)
        sim.advance(0.2)
        whole.append(sim.run)
        sim.restore(state)
        assert (sim.time, sim.held) == (0.3, {})
    assert [run.time[0] for run in whole] == [0.0, 0.0]
    assert whole[0]["a.speed"][-1] > whole[1]["a.speed"][-1]
    other = cw.Simulator(brake(), start=state)
    other.advance(0.1)
    assert other.run.time[0] == 0.3
    other.reset()
    assert (other.time, other.held) == (0.3, {})
    sim.restore(pickle.loads(pickle.dumps(state)))
    assert sim.run.time.tolist() == [0.3]


def test_a_trajectory_of_steps_gives_states_with_what_was_set() -> None:
    sim = cw.Simulator(brake())
    sim.advance(0.1)
    sim.set({"b.pressure": 4e4, "b.gain": 2e-3})
    sim.advance(0.1)
    sim.set("b.pressure", 5e4)
    sim.advance(0.1)
    run = sim.run
    assert [run.state(at).held for at in (0.05, 0.15, 0.25)] == [{}, {"b.pressure": 4e4}, {"b.pressure": 5e4}]
    assert [dict(run.state(at).changed) for at in (0.05, 0.15)] == [{}, {"b.gain": 2e-3}]
    later = cw.simulate(brake(), 0.3, start=run.state(0.2))
    # at 0.2 s the second value was not set yet
    assert later["b.pressure"].tolist() == [4e4] * len(later)
    assert later.state().changed == {"b.gain": 2e-3}
    again = cw.Simulator(brake(), start=run.state(0.2))
    again.set("b.pressure", 5e4)
    again.advance(0.1)
    assert again.save().row == sim.save().row


def loaded(path: Path) -> cw.State | None:
    """A state, or none where the file is refused."""
    try:
        return cw.State.load(path)
    except cw.StateError:
        return None


def test_damaged_states_are_refused(tmp_path: Path) -> None:
    sim = cw.Simulator(brake())
    sim.advance(0.3)
    path, state = tmp_path / "a.state", sim.save()
    state.save(path)
    data, rng = path.read_bytes(), np.random.default_rng(3)
    for place in rng.integers(0, len(data), 200):
        damaged = bytearray(data)
        damaged[place] ^= 1 << int(rng.integers(0, 8))
        path.write_bytes(damaged)
        found = loaded(path)
        # what is not looked at, such as a date
        assert found is None or (found.core, found.row, found.time) == (state.core, state.row, state.time)
    for content in (b"", data[:50], b"PK", b"\0" * 1000):
        path.write_bytes(content)
        with pytest.raises(cw.StateError, match="cannot read a state"):
            cw.State.load(path)
    with pytest.raises(cw.StateError, match="does not exist"):
        cw.State.load(tmp_path / "missing")
    core = bytearray(state.core)
    core[len(core) // 2] ^= 4
    for other in (
        cw.State(state.time, state.model, state.fingerprint, bytes(core), state.row),
        cw.State(state.time, state.model, state.fingerprint, state.core[:-8], state.row),
        cw.State(state.time + 1.0, state.model, state.fingerprint, state.core, state.row),
        cw.State(state.time, state.model, state.fingerprint, state.core, state.row[:-8]),
    ):
        with pytest.raises(cw.StateError, match="damaged"):
            sim.restore(other)
        with pytest.raises(cw.StateError, match="damaged"):
            brake().simulate(2.0, start=other)
    with pytest.raises(cw.UseError, match="3 is not a path"):
        cw.State.load(3)


def test_a_state_of_another_model_is_refused() -> None:
    state = cw.Simulator(brake()).save()
    with pytest.raises(cw.StateError, match=r"'brake' with other numbers or signals: .* Simulator.set"):
        brake(2.0).simulate(1.0, start=state)
    other = cw.Driveline("other")
    other.shaft("a", inertia=1.0)
    with pytest.raises(cw.StateError, match=r"this is a state of 'brake' .* another model"):
        cw.Simulator(other).restore(state)
    with pytest.raises(cw.StateError, match="another model"):
        cw.Simulator(other, start=state)


@pytest.mark.parametrize(
    ("fields", "error", "words"),
    [
        ({"start": 3}, cw.UseError, "start is 3: give what sim.save"),
        ({"t_start": 0.5}, cw.OptionError, "t_start cannot be given beside start: the state is at 0.3 s"),
        ({"t_end": 0.3}, cw.OptionError, "t_end is 0.3 s: it must lie after t_start = 0.3 s"),
        ({"times": [0.1, 0.5]}, cw.OptionError, "must lie between t_start = 0.3 s and t_end = 1 s"),
    ],
)
def test_wrong_starts_are_told(fields: dict[str, object], error: type[Exception], words: str) -> None:
    sim = cw.Simulator(brake())
    sim.advance(0.3)
    with pytest.raises(error, match=words):
        brake().simulate(**{"t_end": 1.0, "start": sim.save()} | fields)
    with pytest.raises(cw.UseError, match=r"at is 2 s: the run goes from 0 to 0.5 s"):
        brake().simulate(0.5).state(2.0)
    with pytest.raises(cw.UseError, match="at is 'end'"):
        brake().simulate(0.5).state("end")


def test_a_run_that_spent_its_budget_goes_on_from_its_state() -> None:
    d = describe(5).driveline()
    with pytest.warns(cw.StoppedEarly):
        first = d.simulate(1.0, max_steps=60, **STEPS)
    rest = d.simulate(1.0, start=first.state(), **STEPS)
    whole = d.simulate(1.0, **STEPS)
    assert rest.finished
    assert rest.time[0] == first.time[-1]
    assert rest.rows[-1].tobytes() == whole.rows[-1].tobytes()
    assert first.statistics["steps"] + rest.statistics["steps"] == whole.statistics["steps"]


def test_a_start_in_the_model_file_and_on_the_command_line(tmp_path: Path) -> None:
    from clutchwork.command.main import main

    d = brake()
    d.simulation = {"t_end": 1.0, "t_start": 0.5}
    d.save(tmp_path / "model.toml")
    assert cw.Driveline.load(tmp_path / "model.toml").simulate().time[0] == 0.5
    assert main(["run", str(tmp_path / "model.toml"), "--quiet", "--t-start", "0.7 s", "--out", str(tmp_path)]) == 0
    heads, first, *_ = next(tmp_path.glob("*.csv")).read_text().splitlines()
    assert heads.startswith("time [s]")
    assert first.startswith("0.7,")
    # a state says where it begins, whatever the settings of the model say
    sim = cw.Simulator(d)
    sim.advance(0.1)
    assert sim.time == 0.6
    assert d.simulate(start=sim.save()).time[0] == 0.6


def test_sweeps_begin_later_too() -> None:
    swept = cw.sweep(
        brake(),
        1.0,
        t_start=0.5,
        vary={"b.gain": [1e-3, 2e-3]},
        outputs={"end": "a.speed", "at": cw.at("a.speed", [0.5, 0.6]), "turned": cw.integral("a.speed")},
    )
    assert swept["end"] == pytest.approx([77.5, 55.0], rel=1e-4)
    assert swept["at"][:, 0].tolist() == [100.0, 100.0]
    assert swept["turned"][0] == pytest.approx(98.75 * 0.1 + 0.4 * 87.5, rel=1e-4)
    with pytest.raises(cw.UseError, match=r"before t_start = 0.5 s"):
        cw.sweep(brake(), 1.0, t_start=0.5, vary={"b.gain": [1.0]}, outputs=cw.at("a.speed", 0.2))


def test_exported_c_begins_there_too(tmp_path: Path) -> None:
    folder = cw.export_c(brake(), tmp_path / "c", t_end=1.0, t_start=0.5, dt=0.2)
    header, tables = ((folder / name).read_text() for name in ("model.h", "model.c"))
    assert "#define MODEL_T_START 0.5 " in header
    # 0.5, 0.7, 0.9 and 1 s
    assert "#define MODEL_INSTANTS 4\n" in header
    assert 'cw_set_option(run, "t_start", 0.5)' in tables
    assert all("MODEL_T_START" in (folder / name).read_text() for name in ("main.c", "main.cpp"))


def launched(engine: float = 100.0, torque: object = 50.0) -> cw.Driveline:
    """An engine, and a car behind a clutch that is pressed."""
    d = cw.Driveline("launched")
    shaft, car = d.shaft("engine", inertia=0.2, speed=engine), d.shaft("car", inertia=1.0)
    d.add(cw.Torque("drive", shaft=shaft, torque=torque))
    friction = cw.Stribeck(static=0.35, kinetic=0.28, speed=10.0)
    d.add(cw.Clutch("c1", base=shaft, follower=car, friction=friction, gain=4e-3, pressure=5e4))
    return d


def test_what_is_set_twice_is_decided_once_however_it_is_looked_at() -> None:
    """Reading and saving between two values at one instant leaves no trace: not in the motion, events or the run."""
    ends = []
    for looks in (False, True):
        sim = cw.Simulator(launched(engine=0.0, torque=10.0))
        for _ in range(3):
            sim.advance(0.01)
            assert sim["c1.state"] == "locked"
            sim.set("c1.pressure", 0.0)
            if looks:
                assert sim["c1.state"] == "open"
                assert [event.after for event in sim.events] == ["open"]
                state = sim.save()
                assert cw.Simulator(launched(engine=0.0, torque=10.0), start=state).events[0].after == "open"
            sim.set("c1.pressure", 4e4)
        sim.advance(0.01)
        assert not len(sim.events)
        assert not len(sim.run.events)
        assert sim.run.rows[-1].tobytes() == sim.save().row
        ends.append((sim.save().row, sim.save().core))
    assert ends[0] == ends[1]


def test_events_of_the_start_come_back_with_its_state() -> None:
    """What the start decides is told again after another start was tried."""
    sim = cw.Simulator(random_contacts(1929))
    sim.set("c1.normal_force", 250.0)
    start, before = sim.save(), list(sim.events)
    assert [event.cause for event in before] == ["impulse"]
    sim.set("load.torque", 80.0)
    sim.restore(start)
    assert list(sim.events) == before
    sim.advance(0.01)
    assert list(sim.events)[:1] == before
    assert list(sim.events) == list(sim.run.events)


@pytest.mark.parametrize("first", [0.0, 0.05])
def test_a_controller_sees_the_same_after_a_state(first: float, tmp_path: Path) -> None:
    """A controller sees what was before a value that is set at its instant, in the run that goes on from there too."""

    def read(_t: float, s: Any) -> float:
        return 50.0 + 0.1 * s["c1.torque"] + 1e-4 * s["c1.pressure"]

    d = launched(torque=cw.Sampled(read, period=0.01))
    sim = cw.Simulator(d)
    sim.advance_to(first)
    sim.set("c1.pressure", 2e4)
    state = sim.save()
    state.save(tmp_path / "a.state")
    sim.advance(0.03)
    wanted = sim.save().row
    other = cw.Simulator(d, start=cw.State.load(tmp_path / "a.state"))
    other.advance(0.03)
    assert other.save().row == wanted
    sim.restore(state)
    sim.advance(0.03)
    assert sim.save().row == wanted
    run = cw.simulate(d, first + 0.03, start=state, output="steps")
    assert run.rows[-1].tobytes() == wanted
    assert run.at([first + 0.03]).rows[-1].tobytes() == wanted


def test_the_instant_of_a_state_may_have_a_unit() -> None:
    """As that of run.at has."""
    run = cw.simulate(launched(), 0.1)
    assert run.state(at="50 ms").core == run.state(at=0.05).core
    with pytest.raises(cw.UseError, match="has a unit that does not fit; give a time in s"):
        run.state(at="5 m")
