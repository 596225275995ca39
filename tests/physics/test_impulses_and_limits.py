"""Impulses with sources, locking within a tolerance, contacts between prescribed speeds, many events at once."""

from __future__ import annotations

import math

import numpy as np
import pytest

import clutchwork as cw
from support.runs import TIGHT, at_end, clutch, switches


def test_a_freewheel_impact_moves_no_friction_clutch() -> None:
    """A source jumps to 10 rad/s and takes b along through a freewheel; c behind a clutch follows with its 1 N m."""
    d = cw.Driveline("impact")
    a, b, c = (d.shaft(name, inertia=1.0) for name in "abc")
    d.add(cw.PrescribedSpeed("source", shaft=a, speed=cw.Step(height=10.0, start=1.0)))
    d.add(cw.OneWayClutch("freewheel", base=a, follower=b))
    d.add(clutch("c1", b, c, kinetic=1.0))
    run = d.simulate(1.5, **TIGHT)
    assert at_end(run, "b.speed") == pytest.approx(10.0, rel=1e-12)
    assert at_end(run, "c.speed") == pytest.approx(0.5, rel=1e-9)
    # 1e-8: asked for
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_a_freewheel_impact_at_the_start_is_paid_by_the_source() -> None:
    """1 kg m2 is brought to 10 rad/s: 100 J from the source, half of it heat."""
    d = cw.Driveline("start")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.PrescribedSpeed("source", shaft=a, speed=10.0))
    d.add(cw.OneWayClutch("freewheel", base=a, follower=b))
    run = d.simulate(0.5, **TIGHT)
    assert run.energy.sources["source"] == pytest.approx(100.0, rel=1e-12)
    assert run.energy.heat["freewheel"] == pytest.approx(50.0, rel=1e-12)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_locking_within_a_tolerance_is_an_impulse() -> None:
    """10 N m stop 1 kg m2 from 10 rad/s: locked at a slip of 2 rad/s, the 2 J left are named."""
    d = cw.Driveline("tolerance")
    a = d.shaft("a", inertia=1.0, speed=10.0)
    law = cw.Coulomb(static=10.0, kinetic=10.0)
    d.add(cw.Brake("b", shaft=a, friction=law, gain=1.0, normal_force=1.0, tolerance=2.0))
    run = d.simulate(1.5, **TIGHT)
    assert [(e.element, e.after) for e in run.events] == [("b", "locked")]
    assert run.events[0].time == pytest.approx(0.8, abs=1e-9)
    assert run.energy.impulses == pytest.approx(2.0, rel=1e-9)
    assert run.energy.heat["b"] == pytest.approx(50.0, rel=1e-9)


def test_what_holds_nothing_and_starts_at_rest_within_its_tolerance_goes_on() -> None:
    """The other side is accelerated from zero on: at the start nothing tells which way it slips."""
    d = cw.Driveline("weightless")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    law = cw.Coulomb(static=0.0, kinetic=0.0)
    d.add(cw.TorqueLimiter("limiter", base=b, follower=a, torque=1.0, friction=law, tolerance=1.0))
    d.add(cw.PrescribedPosition("motion", shaft=a, position=cw.Sine(amplitude=0.05, frequency=1.3)))
    run = d.simulate(0.25, **TIGHT)
    assert run.status == "done"
    # no torque on it at any time
    assert np.ptp(run["b.speed"]) <= 1e-15
    assert run["b.speed"][0] == pytest.approx(0.05 * 2.0 * math.pi * 1.3, rel=1e-12)


def test_a_contact_too_weak_to_lock_goes_on_the_way_it_moves() -> None:
    """-5 N m drive against a brake of 1 N m: 6 rad/s2 down to zero, then 4 rad/s2 the other way."""
    d = cw.Driveline("weak")
    a = d.shaft("a", inertia=1.0, speed=10.0)
    d.add(cw.Torque("drive", shaft=a, torque=-5.0))
    law = cw.Coulomb(static=1.2, kinetic=1.0)
    d.add(cw.Brake("b", shaft=a, friction=law, gain=1.0, normal_force=1.0, tolerance=2.0))
    run = d.simulate(3.0, **TIGHT)
    assert [s[1:] for s in switches(run)] == [("b", "forward", "backward")]
    assert switches(run)[0][0] == pytest.approx(10.0 / 6.0, abs=1e-9)
    assert at_end(run, "a.speed") == pytest.approx(-4.0 * (3.0 - 10.0 / 6.0), rel=1e-9)


def test_contact_between_prescribed_speeds_that_part_smoothly() -> None:
    """Both turn at 100 rad/s, one begins to fall behind with no slope: held, then slipping with its capacity."""
    d = cw.Driveline("rigid")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.PrescribedSpeed("pa", shaft=a, speed=100.0))
    sine = cw.Sine(offset=97.0, amplitude=3.0, frequency=0.2, phase=math.pi / 2)
    d.add(cw.PrescribedSpeed("pb", shaft=b, speed=sine))
    d.add(clutch("c", a, b, kinetic=10.0))
    run = d.simulate(2.0, dt=0.25, **TIGHT)
    assert run.status == "done"
    assert list(run["c.state"][1:]) == ["backward"] * 8
    assert run["c.torque"][1:] == pytest.approx([10.0] * 8, rel=1e-12)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_many_independent_contacts_within_a_microsecond_are_no_zeno_sequence() -> None:
    d = cw.Driveline("many")
    for i in range(60):
        d.add(clutch(f"b{i}", d.housing, d.shaft(f"s{i}", inertia=1.0 + 1e-8 * i, speed=10.0), kinetic=10.0))
    run = d.simulate(1.5, rtol=1e-9, atol=1e-11)
    assert run.status == "done"
    assert len(run.events) == 60


def test_an_instant_asked_for_twice_gives_both_limits_at_the_end_too() -> None:
    d = cw.Driveline("limits")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("t", shaft=a, torque=cw.Step(height=1.0, start=2.0)))
    run = d.simulate(2.0, times=[0.0, 1.0, 1.0, 2.0, 2.0])
    assert np.array_equal(run.time, [0.0, 1.0, 1.0, 2.0, 2.0])
    assert list(run["a.acceleration"]) == [0.0, 0.0, 0.0, 0.0, 1.0]


@pytest.mark.parametrize("over", [1e-2, 1e-4])
@pytest.mark.parametrize("weak", [0.0, 0.003, 0.01])
def test_a_brake_that_holds_little_one_way_lets_go_in_each_period(weak: float, over: float) -> None:
    """Its torque turns within a step, and is small against what it holds the other way at both ends of it."""
    mean, swing, frequency = 1.0, 1.0 + weak + over, 5.72
    d = cw.Driveline("one way")
    s = d.shaft("s", inertia=1.0)
    brake = cw.FundamentalClutch("b", base=d.housing, follower=s, kinetic=0.0, upper=weak, lower=-60.0, locked=True)
    d.add(brake)
    d.add(cw.Torque("t", shaft=s, torque=cw.Sine(amplitude=swing, offset=mean, frequency=frequency)))
    run = d.simulate(0.9)
    first = (np.pi + np.arcsin((mean + weak) / swing)) / (2.0 * np.pi * frequency)
    found = [event.time for event in run.events.of("b") if event.before == "locked"]
    assert found == pytest.approx(first + np.arange(5) / frequency, abs=1e-8)
    assert np.max(run["b.torque"]) <= weak + 1e-9


def test_no_freewheel_gives_heat() -> None:
    """A freewheel that another one strikes is driven by it: what is lost is the heat of the other."""
    d = cw.Driveline("two freewheels")
    s1, s2 = d.shaft("s1", inertia=1.0, speed=-5.0), d.shaft("s2", inertia=0.02, speed=10.0)
    first, second = (d.thermal(name, capacity=1.0, temperature=300.0) for name in ("first", "second"))
    d.add(cw.OneWayClutch("a", base=s2, follower=s1, heat=first))
    d.add(cw.OneWayClutch("b", base=d.housing, follower=s2, heat=second))
    run = d.simulate(0.1)
    assert (at_end(run, "a.heat"), at_end(run, "b.heat")) == pytest.approx((13.5, 0.0), rel=1e-12)
    assert (at_end(run, "first.temperature"), at_end(run, "second.temperature")) == pytest.approx((313.5, 300.0))


@pytest.mark.parametrize("seed", range(30))
def test_heats_of_impulses_are_positive_and_what_is_lost(seed: int) -> None:
    rng = np.random.default_rng([seed, 15])
    d = cw.Driveline("chain")
    speeds, inertias = rng.uniform(-10.0, 10.0, 5), 10.0 ** rng.uniform(-2.0, 0.0, 5)
    shafts = [d.shaft(f"s{k}", inertia=inertias[k], speed=speeds[k]) for k in range(5)]
    for k, (base, follower) in enumerate(zip([d.housing, *shafts], shafts, strict=False)):
        d.add(cw.OneWayClutch(f"f{k}", base=base, follower=follower))
    run = d.simulate(0.01)
    after = np.array([at_end(run, f"s{k}.speed") for k in range(5)])
    heats = np.array([at_end(run, f"f{k}.heat") for k in range(5)])
    lost = 0.5 * float(inertias @ (speeds**2 - after**2))
    assert np.all(heats >= 0.0)
    assert heats.sum() == pytest.approx(lost, rel=1e-9)


@pytest.mark.parametrize("seed", range(60))
def test_a_freewheel_beside_a_clutch_carries_nothing(seed: int) -> None:
    """Round-off alone loads it: what another shaft does beside it is decided as without it."""
    rng = np.random.default_rng([seed, 1])
    torque, inertia = float(rng.uniform(5.5, 40.0)), rng.uniform(0.1, 3.0, 2).tolist()
    d = cw.Driveline("hangs on")
    hung, driven, held = (
        d.shaft(n, inertia=j) for n, j in zip(("hung", "driven", "held"), (inertia[0], 1.0, inertia[1]), strict=True)
    )
    pads = cw.Coulomb(static=0.25, kinetic=0.25)
    d.add(cw.Torque("drive", shaft=driven, torque=torque))
    d.add(cw.Brake("brake", shaft=held, friction=pads, gain=1.0, normal_force=float(rng.uniform(21.0, 60.0))))
    d.add(cw.OneWayClutch("freewheel", base=hung, follower=held))
    d.add(cw.Clutch("slips", base=driven, follower=held, friction=pads, gain=1.0, normal_force=20.0))
    d.add(cw.Clutch("beside", base=hung, follower=held, friction=pads, gain=1.0, normal_force=20.0))
    run = d.simulate(0.5)
    assert run.status == "done"
    assert at_end(run, "driven.speed") == pytest.approx(0.5 * (torque - 5.0), rel=1e-9)
    assert at_end(run, "held.speed") == 0.0
