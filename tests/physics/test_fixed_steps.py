"""Steps of one length: their order, events, energy, bounded cost, saved states, and what they refuse.

docs/theory/fixed-steps.md
"""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.layout import DONE, MOST_FIXED_SPEEDS
from clutchwork.declare.options import Options
from clutchwork.declare.schema import REGISTRY, Role
from clutchwork.run.begin import choose, new_run
from support import cases, random_contacts, samples, six_speed
from support.pages import page, table

SPEEDS = ("w1", "w2", "w4", "w8")
GUIDE = page("guide/fixed-steps.md")
# the largest number of sets of free contacts that a step may try, of up to four rounds
MOST_SETS, MOST_ROUNDS = 45, 4


def fixed(step: float, **options: Any) -> dict[str, Any]:
    return {"method": "fixed", "step": step, **options}


def line(*, events: bool) -> cw.Driveline:
    """Two discs on a spring, driven by a sine, and a third one that a clutch drags along, or locks to them."""
    d = cw.Driveline("line")
    a, b = d.shaft("a", inertia=0.3, speed=60.0), d.shaft("b", inertia=0.5, speed=20.0 if events else 50.0)
    c = d.shaft("c", inertia=0.4, speed=0.0 if events else -300.0)
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=120.0, damping=0.4))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=90.0, frequency=1.3)))
    d.add(cw.QuadraticTorque("drag", shaft=a, nominal_torque=-20.0, nominal_speed=60.0))
    law = cw.Exponential(static=0.16, slow=0.14, fast=0.065, speed=30.0)
    d.add(cw.Clutch("f", base=b, follower=c, friction=law, gain=1.0, normal_force=190.0))
    return d


@pytest.mark.parametrize(("events", "order", "off"), [(False, 2.0, 0.1), (True, 1.5, 0.6)])
def test_order(events: bool, order: float, off: float) -> None:
    """Two between events. An event costs one at worst, two where its instant is met as here."""
    system = line(events=events).assemble()
    times = [0.5, 0.65, 0.8, 1.0]

    def speeds(**options: Any) -> np.ndarray:
        run = cw.simulate(system, 1.0, times=times, **options)
        assert bool(run.events.changes()) == events
        return np.array([run[f"{name}.speed"] for name in "abc"])

    exact = speeds(rtol=1e-12, atol=1e-12)
    steps = [1.0 / n for n in (100, 141, 200, 283, 400, 566, 800)]
    errors = [np.sqrt(np.mean((speeds(**fixed(step)) - exact) ** 2)) for step in steps]
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope > order - off, errors
    assert events or slope == pytest.approx(order, abs=off), errors


@cache
def shift(step: float) -> tuple[cw.Trajectory, cw.Trajectory]:
    """The 3-4 shift with steps of one length, and exactly."""
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    times = np.linspace(0.0, 4.0, 2001)
    return (
        cw.simulate(system, 4.0, times=times, **fixed(step)),
        cw.simulate(system, 4.0, times=times, rtol=1e-11, atol=1e-11),
    )


def test_the_shift_of_the_six_speed_gearbox() -> None:
    run, exact = shift(1e-3)
    # 1e-2 rad/s: asked for, of pressures with slopes; 9.3e-3 measured
    assert max(np.abs(run[f"{name}.speed"] - exact[f"{name}.speed"]).max() for name in SPEEDS) < 1e-2
    assert [(e.element, e.before, e.after, e.cause) for e in run.events] == [
        (e.element, e.before, e.after, e.cause) for e in exact.events
    ]
    # hundredths of a step: 1e-7 s and 1.2e-5 s measured
    for mine, theirs, most in zip(run.events, exact.events, (1e-5, 5e-5), strict=True):
        assert mine.time == pytest.approx(theirs.time, abs=most)
    # what a step is, not the grid of rows, decides
    assert run.statistics["steps"] == 4000


def test_the_launch_and_shift_of_an_independent_solver() -> None:
    folder = cases.folder("six_speed")
    case = json.loads((folder / "case.json").read_text())
    times, reference = cases.table(folder / "reference.csv")
    d = six_speed.gearbox(case["pressures_Pa"], case["initial_speeds_rad_s"])
    run = d.simulate(case["t_end_s"], times=times, **fixed(1e-3))
    for name in SPEEDS:
        off = np.abs(run[f"{name}.speed"] - reference[name]).max()
        # twice the bound of the shift alone, as the launch adds an engagement; 1.4e-2 measured
        assert off < 2e-2, name


def test_a_locked_contact_does_not_slip() -> None:
    run, _ = shift(1e-3)
    locked = run["F4.mode"] == 0
    assert locked.any()
    assert np.all(run["F4.slip"][locked] == 0.0)


def test_each_step_closes_the_balance_of_energy() -> None:
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    run = cw.simulate(system, 4.0, output="steps", **fixed(1e-3))
    assert run.energy.residual < 1e-13 * run.energy.turnover
    kinetic = sum(0.5 * inertia * run[f"{name}.speed"] ** 2 for name, inertia in six_speed.INERTIA.items())
    works = sum(run[f"{name}.work"] for name in ("engine", "load", "shaft", "F1", "F2", "F4"))
    # of each step, against round-off of sums of up to 1e6 J
    assert np.abs(np.diff(kinetic - works)).max() < 1e-8


def test_a_spring_keeps_its_energy_for_a_million_steps() -> None:
    d = cw.Driveline("swing")
    a, b = d.shaft("a", inertia=1.0, speed=1.0), d.shaft("b", inertia=2.0)
    d.add(cw.Spring("k", base=a, follower=b, stiffness=400.0))
    run = d.simulate(1000.0, times=np.linspace(999.0, 1000.0, 1001), **fixed(1e-3))
    assert run.statistics["steps"] == 1_000_000
    energy = 0.5 * run["a.speed"] ** 2 + run["b.speed"] ** 2 + 0.5 * run["k.torque"] ** 2 / 400.0
    # rows have the torque in the middle of a step, half a step before its speeds: w h / 2 of 1 % of the energy
    assert np.abs(energy / 0.5 - 1.0).max() < 2e-2
    assert run.energy.residual < 1e-9


def test_the_iterations_of_each_step_are_bounded() -> None:
    """Random drivelines with two to six contacts, some of which depend on each other."""
    most = 0
    for seed in range(40):
        system = random_contacts.driveline(seed).assemble()
        run = new_run(system.to_bytes())
        choose(run, Options(method="fixed", step=1e-3))
        before = run.statistics()["evaluations"]
        for number in range(1, 400):
            status, _, _ = run.advance(number * 1e-3, np.empty(0), np.empty((0, run.row_size)), 0, 0)
            if status != DONE:
                break
            run.events()
            after = run.statistics()["evaluations"]
            # the first row is that of an event
            most = max(most, after - before) if number > 1 else most
            before = after
    assert 1 < most <= MOST_SETS * MOST_ROUNDS
    # 3 to 6 contacts take less than a dozen
    assert most <= 12


def test_parallel_clutches_share_as_their_capacity() -> None:
    d = cw.Driveline("parallel")
    a, b = d.shaft("a", inertia=1.0, speed=0.0), d.shaft("b", inertia=1.0, speed=0.0)
    d.add(cw.Torque("t", shaft=a, torque=10.0))
    for name, force in (("one", 100.0), ("two", 300.0)):
        law = cw.Coulomb(static=0.2, kinetic=0.1)
        d.add(cw.Clutch(name, base=a, follower=b, friction=law, gain=1.0, normal_force=force))
    run = d.simulate(0.1, **fixed(1e-2))
    # half of the torque drives the second shaft; the share is round-off, 1e-16, over the weight of 1e-10
    assert run["one.torque"][-1] == pytest.approx(1.25, rel=1e-5)
    assert run["two.torque"][-1] == pytest.approx(3.75, rel=1e-5)


def test_freewheels_and_sprags_beside_clutches() -> None:
    """Random drivelines with up to six contacts; sprags give way for good, as in the exact motion."""
    far = []
    for seed in range(40):
        system = random_contacts.driveline(seed).assemble()
        run = cw.simulate(system, 0.5, times=[0.1, 0.3, 0.5], **fixed(1e-4))
        exact = cw.simulate(system, 0.5, times=[0.1, 0.3, 0.5])
        assert run.finished, f"seed {seed}: {run.message}"
        speeds = [f"{node.name}.speed" for node in run.wiring.nodes]
        largest = max(np.abs(exact[name]).max() for name in speeds)
        far.append(max(np.abs(run[name] - exact[name]).max() for name in speeds) / (1.0 + largest))
    # of the largest speed: events cost an order, and steps of locking follow each other
    assert np.median(far) < 1e-3
    assert np.max(far) < 5e-2


def test_static_friction_does_not_chatter() -> None:
    """A block on a belt: it sticks and slips, with the same number of events as the exact motion."""
    d = cw.Driveline("stick-slip")
    belt, block = d.shaft("belt", speed=1.0), d.shaft("block", inertia=1.0)
    d.add(cw.PrescribedSpeed("drive", shaft=belt, speed=1.0))
    d.add(cw.SpringDamper("k", base=d.housing, follower=block, stiffness=100.0, damping=0.1))
    law = cw.Stribeck(static=0.3, kinetic=0.15, speed=0.1)
    d.add(cw.Clutch("f", base=belt, follower=block, friction=law, gain=1.0, normal_force=100.0))
    exact, run = d.simulate(5.0), d.simulate(5.0, **fixed(1e-3))
    assert [e.cause for e in run.events] == [e.cause for e in exact.events]
    # ten cycles, each with an event of some microseconds
    assert np.allclose([e.time for e in run.events], [e.time for e in exact.events], atol=2e-3)


def test_states_go_on_with_the_same_bits() -> None:
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    times = [2.5, 2.501, 3.0, 4.0]
    whole = cw.simulate(system, 4.0, times=times, **fixed(1e-3))
    state = cw.simulate(system, 4.0, **fixed(1e-3)).state(2.5)
    rest = cw.simulate(system, 4.0, times=times, start=state, **fixed(1e-3))
    assert rest.rows.tobytes() == whole.rows.tobytes()
    # another method goes on from there, too
    other = cw.simulate(system, 4.0, times=times, start=state)
    assert np.abs(other["w8.speed"] - whole["w8.speed"]).max() < 1e-2


def test_steps_by_hand_are_those_of_the_run() -> None:
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    whole = cw.simulate(system, 2.4, times=[2.4], **fixed(1e-3))
    sim = cw.Simulator(system, **fixed(1e-3))
    for _ in range(240):
        sim.advance(0.01)
    assert sim["w8.speed"] == pytest.approx(whole["w8.speed"][-1], rel=1e-12)


def test_an_end_between_two_steps_is_reached_by_a_shorter_one() -> None:
    run = line(events=False).simulate(0.0125, output="steps", **fixed(5e-3))
    assert run.time.tolist() == [0.0, 0.005, 0.01, 0.0125]


def test_a_sweep_has_the_runs() -> None:
    d = line(events=True)
    found = cw.sweep(d, 1.0, vary={"a.inertia": [0.2, 0.3]}, outputs=["a.speed"], **fixed(1e-3))
    assert found["a.speed"][1] == d.simulate(1.0, times=[1.0], **fixed(1e-3))["a.speed"][-1]


def refused_kinds() -> dict[str, str]:
    """Kinds of elements and laws that the guide names, with the reason."""
    return {kind: why for kinds, why in table(GUIDE, "refused") for kind in kinds.replace("`", "").split(", ")}


@pytest.mark.parametrize("kind", sorted(REGISTRY[Role.LAW]))
def test_laws_are_taken_or_refused_as_the_guide_says(kind: str) -> None:
    d = cw.Driveline(kind)
    a, b = d.shaft("a", inertia=1.0, speed=5.0), d.shaft("b", inertia=1.0)
    law = samples.law(REGISTRY[Role.LAW][kind])
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1.0, normal_force=10.0))
    taken_or_refused(d, kind)


@pytest.mark.parametrize("cls", samples.declared(*samples.ELEMENT_ROLES), ids=lambda cls: cls.kind)
def test_elements_are_taken_or_refused_as_the_guide_says(cls: Any) -> None:
    taken_or_refused(samples.driveline(cls), cls.kind)


def taken_or_refused(d: cw.Driveline, kind: str) -> None:
    known = refused_kinds()
    if kind not in known:
        run = d.simulate(0.02, **fixed(1e-3))
        assert run.finished, run.message
        return
    with pytest.raises(cw.OptionError) as error:
        d.simulate(0.02, **fixed(1e-3))
    assert 'method is "fixed"' in str(error.value)
    assert known[kind] in str(error.value)


def test_what_refuses_says_so_before_it_runs() -> None:
    d, law = cw.Driveline("jumps"), samples.law(REGISTRY[Role.LAW]["naive_sign"])
    a, b = d.shaft("a", inertia=1.0, speed=5.0), d.shaft("b", inertia=1.0)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1.0, normal_force=10.0))
    for call in (
        lambda: cw.Simulator(d, method="fixed"),
        lambda: cw.sweep(d, 1.0, vary={"a.inertia": [1.0]}, outputs=["a.speed"], method="fixed"),
        lambda: cw.simulate(d, 1.0, method="fixed"),
    ):
        with pytest.raises(cw.OptionError, match="'c', for its law jumps"):
            call()


def light(*, clutch: bool) -> cw.Driveline:
    """Discs, between them a damper, a shaft without inertia, and a spring; a clutch from there to a third disc."""
    d = cw.Driveline("light")
    a, b, c = d.shaft("a", inertia=1.0, speed=30.0), d.shaft("b"), d.shaft("c", inertia=1.0)
    d.add(cw.Damper("slide", base=a, follower=b, damping=8.0))
    d.add(cw.SpringDamper("spring", base=b, follower=c, stiffness=400.0, damping=1.0))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=40.0, frequency=2.0)))
    if clutch:
        e = d.shaft("e", inertia=0.2)
        law = cw.Stribeck(static=0.35, kinetic=0.28, speed=1.0)
        pressure = cw.Sine(amplitude=1e4, frequency=0.9, offset=1.1e4)
        d.add(cw.Clutch("f", base=c, follower=e, friction=law, gain=4e-3, pressure=pressure))
        d.add(cw.Damper("drag", base=d.housing, follower=e, damping=0.5))
    return d


def test_shafts_without_inertia_keep_their_accuracy_where_steps_are_cut() -> None:
    """Calls that end between two points of the grid shorten steps; the line through two middles knows their lengths."""
    exact = light(clutch=False).simulate(0.5, times=[0.5], rtol=1e-10, atol=1e-12)
    errors = []
    for call in (1e-3, 1.1e-3):
        sim = cw.Simulator(light(clutch=False).assemble(), method="fixed", step=1e-3)
        while sim.time < 0.5 - 1e-9:
            sim.advance(min(call, 0.5 - sim.time))
        errors.append(abs(sim["b.speed"] - float(exact["b.speed"][-1])))
    # the cut steps alone are as short as a tenth: they add no more than the whole ones
    assert errors[1] < 5.0 * errors[0]


@pytest.mark.parametrize(("clutch", "order"), [(False, 2.0), (True, 1.0)])
def test_shafts_without_inertia(clutch: bool, order: float) -> None:
    """Of second order between events, of first order at them, and nothing rings from step to step."""
    system, times = light(clutch=clutch).assemble(), np.linspace(0.1, 2.0, 39)

    def speeds(**options: Any) -> np.ndarray:
        run = cw.simulate(system, 2.0, times=times, **options)
        assert abs(run.energy.residual) < 1e-9 * run.energy.turnover
        return np.array([run[f"{name}.speed"] for name in "abc"])

    exact = speeds(rtol=1e-11, atol=1e-11)
    steps = [2e-3, 1e-3, 5e-4, 2.5e-4]
    errors = [np.sqrt(np.mean((speeds(**fixed(step)) - exact) ** 2)) for step in steps]
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope > order - 0.2, errors
    run = cw.simulate(system, 2.0, output="steps", **fixed(1e-3))
    rough = np.abs(np.diff(run["b.speed"], 3))
    # of a motion at some hertz third differences are 1e-6 of the speeds; what rings would be in them eightfold
    assert np.median(rough) < 1e-4


def chain(count: int) -> cw.Driveline:
    """Discs on springs, with a clutch at the end that drags another one along."""
    d = cw.Driveline("chain")
    shafts = [d.shaft(f"s{i}", inertia=0.1 + 0.01 * i, speed=20.0 if i < count - 1 else 0.0) for i in range(count)]
    for i in range(count - 2):
        d.add(cw.SpringDamper(f"k{i}", base=shafts[i], follower=shafts[i + 1], stiffness=200.0, damping=0.3))
    d.add(cw.Torque("drive", shaft=shafts[0], torque=cw.Sine(amplitude=30.0, frequency=1.5)))
    law = cw.Stribeck(static=0.35, kinetic=0.28, speed=1.0)
    pressure = cw.Table([(0.0, 0.0), (0.3, 8e3), (1.0, 8e3)])
    d.add(cw.Clutch("f", base=shafts[-2], follower=shafts[-1], friction=law, gain=4e-3, pressure=pressure))
    return d


@pytest.mark.parametrize("count", [14, 40])
def test_many_speeds(count: int) -> None:
    d, times = chain(count), np.linspace(0.05, 1.0, 20)
    exact = d.simulate(1.0, times=times, rtol=1e-10)
    errors = []
    for step in (1e-3, 5e-4):
        run = d.simulate(1.0, times=times, **fixed(step))
        assert [(e.element, e.after) for e in run.events] == [(e.element, e.after) for e in exact.events]
        assert abs(run.energy.residual) < 1e-9 * run.energy.turnover
        errors.append(max(np.abs(run[f"s{i}.speed"] - exact[f"s{i}.speed"]).max() for i in range(count)))
    # rad/s of 20: the fastest mode has 13 Hz
    assert errors[1] < 0.4 * errors[0] < 0.4 * 2e-2


def test_too_many_speeds_are_refused() -> None:
    with pytest.raises(cw.OptionError, match=f"more than {MOST_FIXED_SPEEDS} independent speeds"):
        chain(MOST_FIXED_SPEEDS + 3).simulate(1.0, **fixed(1e-3))


def test_derivatives_are_refused() -> None:
    with pytest.raises(cw.UseError, match='method is "fixed"'):
        cw.differentiable(line(events=True), 1.0, of=["a.speed"], by=["a.inertia"], method="fixed")


def test_energy_does_not_drift() -> None:
    """docs/guide/fixed-steps.md: 300 000 steps of a clutch that locks and slips."""
    d = cw.Driveline("shuttle")
    a, b = d.shaft("a", inertia=0.2, speed=10.0), d.shaft("b", inertia=0.5)
    c = d.shaft("c", inertia=0.3)
    lining = cw.Stribeck(static=0.35, kinetic=0.28, speed=1.0)
    pressure = cw.Sine(amplitude=1e4, frequency=0.5, offset=1.2e4)
    d.add(cw.Clutch("clutch", base=a, follower=b, friction=lining, gain=4e-3, pressure=pressure))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=60.0, frequency=0.3)))
    d.add(cw.SpringDamper("spring", base=b, follower=c, stiffness=500.0, damping=1.0))
    d.add(cw.Damper("drag", base=d.housing, follower=c, damping=0.3))
    run = d.simulate(300.0, method="fixed", step=1e-3, times=[0.0, 300.0])
    assert len(run.events) > 100
    # round-off of as many additions, at random: some 1e-13
    assert abs(run.energy.residual) < 1e-10 * run.energy.turnover


def test_a_contact_between_steps_is_that_of_the_last_one() -> None:
    """One that never sticks is read the way it slips, prescribed speeds included, also where something was set."""
    d = cw.Driveline("belt")
    belt, disc = d.shaft("belt", inertia=0.1), d.shaft("disc", inertia=0.1)
    d.add(cw.PrescribedSpeed("drive", shaft=belt, speed=10.0))
    d.add(cw.Torque("brake", shaft=disc, torque=0.0))
    law = cw.Tanh(kinetic=0.3, speed=0.5)
    d.add(cw.Clutch("c", base=belt, follower=disc, friction=law, gain=1.0, normal_force=3.0))
    sim = cw.Simulator(d, method="fixed", step=1e-3)
    sim.advance(5e-3)
    before = sim["c.state"], sim["c.slip"], sim["disc.speed"]
    sim.set("brake.torque", 0.1)
    assert (sim["c.state"], sim["c.slip"], sim["disc.speed"]) == before
    assert before[0] == "backward"


@pytest.mark.parametrize("how", ["knots", "set", "set with another"])
def test_what_is_read_in_the_middle_of_a_step_does_not_ask_where_other_signals_have_knots(how: str) -> None:
    """An accumulator that is fed by a ramp, beside a torque with knots in the second half of steps."""

    def pressures(knots: bool) -> list[float]:
        d = cw.Driveline("beside")
        a = d.shaft("a", inertia=1.0)
        points = [(0.0, 1.0), (0.0058, 1.0), (0.01, 2.0)]
        d.add(cw.Torque("t", shaft=a, torque=cw.Table(points) if knots else 1.0))
        d.add(cw.Torque("other", shaft=a, torque=0.0))
        inflow = cw.Table([(0.0, 0.0), (0.02, 2e-5)])
        d.add(cw.Accumulator("acc", precharge=5e5, capacity=2e-4, inflow=inflow))
        sim = cw.Simulator(d, method="fixed", step=1e-3)
        sim.advance(1e-3)
        if how != "knots":
            sim.set({"t.torque": 5.0} if how == "set" else {"t.torque": 5.0, "other.torque": 1.0})
        found = []
        for _ in range(12):
            sim.advance(1e-3)
            found.append(sim["acc.pressure"])
        return found

    assert pressures(knots=True) == pressures(knots=False)
