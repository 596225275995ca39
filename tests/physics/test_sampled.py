"""Steps that a controller sets are the steps of a table: same events, same torques, same energies."""

from __future__ import annotations

import traceback
import warnings
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support import random_drivelines
from support.amount import amount
from support.random_drivelines import HOUSING, Description

T_END = 0.7
Steps = list[float]
Signals = Callable[[Steps, float], Any]


def as_table(values: Steps, period: float) -> Any:
    """Steps at whole multiples of a period, each of them two points."""
    points = [(0.0, values[0])]
    for number, (before, after) in enumerate(pairwise(values), 1):
        points += [(number * period, before), (number * period, after)]
    return cw.Table([*points, (1e3, values[-1])])


def as_sampled(values: Steps, period: float) -> Any:
    """The same as a Python function."""
    return cw.Sampled(lambda time, readings: values[round(time / period)], period)


def as_changes(values: Steps, period: float) -> Any:
    """The same as a table that has knots only where the value changes."""
    points = [(0.0, values[0])]
    for number, (before, after) in enumerate(pairwise(values), 1):
        points += [(number * period, before), (number * period, after)] if before != after else []
    return cw.Table([*points, (1e3, values[-1])])


def stepped(model: Description, make: Signals, seed: int) -> cw.Driveline:
    """A random driveline whose pressures and torque go in steps; the third clutch has a table with their instants."""
    rng = np.random.default_rng(seed)
    d = cw.Driveline(f"stepped {model.seed}")
    nodes = {HOUSING: d.housing}
    nodes |= {i: d.shaft(f"s{i}", inertia=model.inertia[i], speed=model.speed[i]) for i in range(len(model.inertia))}

    def steps(largest: float, period: float, make: Signals = make) -> Any:
        count = round(T_END / period) + 1
        levels = rng.uniform(0.0, largest, count) * (rng.random(count) < 0.8)
        kept = np.maximum.accumulate(np.arange(count) * (rng.random(count) < 0.6))
        return make([float(x) for x in levels[kept]], period)

    for i, c in enumerate(model.clutches):
        law = cw.Exponential(static=c.static, slow=c.slow, fast=c.fast, speed=c.speed)
        # fractions of two, whose multiples are the same however they are counted
        pressure = steps(1e6, 1 / 16, as_table) if i == 2 else steps(1e6, (1 / 16, 1 / 32)[i])
        ends = {"base": nodes[c.base], "follower": nodes[c.follower]}
        d.add(cw.Clutch(f"c{i}", friction=law, gain=c.gain, pressure=pressure, **ends))
    for i, k in enumerate(model.shafts):
        ends = {"base": nodes[k.base], "follower": nodes[k.follower]}
        d.add(cw.SpringDamper(f"k{i}", stiffness=k.stiffness, damping=k.damping, **ends))
    d.add(cw.Torque("t", shaft=nodes[model.drives[0].shaft], torque=steps(2.0 * model.drives[0].offset, 1 / 8)))
    for i, r in enumerate(model.loads):
        d.add(cw.ResistingTorque(f"r{i}", shaft=nodes[r.shaft], torque=r.torque, speed=r.speed))
    return d


def run(d: cw.Driveline, t_end: float = T_END, **options: Any) -> Any:
    # friction models of this size may judder; a run that stops early does so either way
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.StoppedEarly)
        return d.simulate(t_end, **options)


def same_events(one: Any, other: Any, tolerance: float) -> None:
    """Contact, modes and cause equal; times, torques and energies to a tolerance of their scale."""
    names = [[(e.element, e.before, e.after, e.cause) for e in r.events] for r in (one, other)]
    assert names[0] == names[1]
    scales = {"time": 1.0, "torque_before": 1e3, "torque_after": 1e3, "energy_before": 1e5, "energy_after": 1e5}
    for a, b in zip(one.events, other.events, strict=True):
        for what, scale in scales.items():
            assert getattr(a, what) == pytest.approx(getattr(b, what), abs=tolerance * scale, rel=0), (what, a, b)


@pytest.mark.random
def test_a_controller_makes_the_events_of_a_table_in_random_drivelines() -> None:
    seen = 0
    for seed in range(amount()):
        model = random_drivelines.describe(seed)
        table, sampled = (run(stepped(model, make, seed)) for make in (as_table, as_sampled))
        same_events(sampled, table, 1e-9)
        assert sampled.status == table.status
        seen += sum(e.cause == "input" for e in table.events)
    assert seen > amount()


@pytest.mark.random
def test_knots_that_change_nothing_make_no_difference() -> None:
    for seed in range(amount() // 10):
        model = random_drivelines.describe(seed)
        table, sampled = (run(stepped(model, make, seed), rtol=1e-10, atol=1e-10) for make in (as_changes, as_sampled))
        same_events(sampled, table, 1e-6)


def locked_pair(pressure: Any) -> cw.Driveline:
    """A clutch that starts locked and carries 5 N m of 10 N m; the other half goes into the second shaft."""
    d = cw.Driveline("pair")
    a, b = d.shaft("a", inertia=1.0, speed=50.0), d.shaft("b", inertia=1.0, speed=50.0)
    law = cw.Coulomb(static=0.13, kinetic=0.12)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1e-3, pressure=pressure, locked=True))
    d.add(cw.Torque("t", shaft=a, torque=10.0))
    return d


def test_the_start_is_decided_with_the_first_value() -> None:
    """No clutch opens and closes again at 0 s, and what the first call reads is the start without its value."""
    read: list[dict[str, Any]] = []

    def pressure(time: float, readings: Any) -> float:
        read.append({name: readings[name] for name in ("a.speed", "c.capacity", "c.pressure")})
        return 1e5 if time < 0.5 else 1e4

    sampled = locked_pair(cw.Sampled(pressure, 0.25)).simulate(1.0)
    table = locked_pair(cw.Table([(0.0, 1e5), (0.5, 1e5), (0.5, 1e4)])).simulate(1.0)
    same_events(sampled, table, 1e-12)
    assert [(e.time, e.before, e.after) for e in sampled.events.changes()] == [(0.5, "locked", "backward")]
    assert sampled["c.torque"][0] == pytest.approx(5.0, abs=1e-12)
    assert sampled["c.state"][0] == "locked"
    assert read[0] == {"a.speed": 50.0, "c.capacity": 0.0, "c.pressure": 0.0}
    # just before a call: the value set last, and the torque that it allows
    assert read[2] == {"a.speed": pytest.approx(52.5, abs=1e-9), "c.capacity": pytest.approx(13.0), "c.pressure": 1e5}


def test_the_torque_before_a_step_is_what_the_trajectory_shows() -> None:
    run = locked_pair(cw.Sampled(lambda time, readings: 1e5 if time < 0.5 else 1e4, 0.01)).simulate(1.0)
    (event,) = run.events.changes()
    before = np.flatnonzero(run.time <= event.time)[0:]
    rows = before[run.time[before] < event.time]
    assert event.torque_before == pytest.approx(run["c.torque"][rows[-1]], rel=1e-9)
    assert event.torque_before == pytest.approx(5.0, abs=1e-9)
    assert event.torque_after == pytest.approx(1.2, abs=1e-12)
    at = np.flatnonzero(run.time == event.time)
    # both limits stand in the trajectory
    assert [run["c.torque"][i] for i in (at[0], at[-1])] == pytest.approx([5.0, 1.2], abs=1e-9)


def test_a_speed_that_a_controller_sets_jumps_as_that_of_a_table() -> None:
    """From 0 to 3 rad/s at once, where a locked clutch cannot follow; the source pays for the impulse."""

    def model(speed: Any) -> cw.Driveline:
        d = cw.Driveline("bench")
        a, b = d.shaft("a", inertia=0.5), d.shaft("b", inertia=1.0)
        d.add(cw.PrescribedSpeed("p", shaft=a, speed=speed))
        law = cw.Coulomb(static=0.13, kinetic=0.12)
        d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1e-3, pressure=1e5))
        return d

    values = [2.0, 2.0, 3.0, 3.0, 1.0]
    runs = [model(make(values, 0.25)).simulate(1.2) for make in (as_table, as_sampled)]
    same_events(runs[1], runs[0], 1e-12)
    assert runs[1]["a.speed"][0] == 2.0
    assert [float(r["p.work"][-1]) for r in runs] == pytest.approx([float(runs[0]["p.work"][-1])] * 2, rel=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_a_run_takes_the_same_steps_whether_or_not_rows_are_asked_for_between(seed: int) -> None:
    """A run of bare steps reads a row after every call, one on a grid does not."""
    steps = run(stepped(random_drivelines.describe(seed), as_sampled, seed), output="steps")
    again = steps.at(steps.time)
    assert again.statistics["steps"] == steps.statistics["steps"]
    assert np.max(np.abs(again["s0.speed"] - steps["s0.speed"])) <= 1e-12 * np.max(np.abs(steps["s0.speed"]))


@pytest.mark.parametrize("seed", range(8))
def test_rows_on_a_grid_are_those_of_a_table(seed: int) -> None:
    """Also at the instants of the steps, once or with both limits."""
    model, times = random_drivelines.describe(seed), np.repeat(np.arange(1, 90) / 128, np.arange(1, 90) % 3 % 2 + 1)
    table, sampled = (run(stepped(model, make, seed), times=times) for make in (as_table, as_sampled))
    for name in ("s0.speed", "c0.torque", "c0.pressure", "c1.torque", "t.torque"):
        scale = np.max(np.abs(table[name]))
        assert np.max(np.abs(sampled[name] - table[name])) <= 1e-9 * scale, name


def test_a_controller_that_fails_hands_over_its_error_and_the_trajectory_so_far() -> None:
    def fails(time: float, readings: Any) -> float:
        return 1e5 if time < 0.5 else 1 / 0

    with pytest.raises(cw.SimulationError, match=r"controller of 'c.pressure' failed at 0.5 s: ZeroDivision") as caught:
        locked_pair(cw.Sampled(fails, 0.25)).simulate(1.0)
    assert isinstance(caught.value.__cause__, ZeroDivisionError)
    # the traceback leads into the function
    frames = [entry.name for entry in traceback.extract_tb(caught.value.__cause__.__traceback__)]
    assert frames[-1] == "fails"
    assert caught.value.trajectory is not None
    assert caught.value.trajectory.time[-1] == 0.5
    assert caught.value.trajectory["a.speed"][-1] == pytest.approx(52.5, abs=1e-9)


def test_a_reading_that_is_misspelt_is_answered_with_a_near_name() -> None:
    with pytest.raises(cw.SimulationError, match=r"no signal 'a.sped'; did you mean 'a.speed'\?") as caught:
        locked_pair(cw.Sampled(lambda time, readings: readings["a.sped"], 0.25)).simulate(1.0)
    assert isinstance(caught.value.__cause__, KeyError)
