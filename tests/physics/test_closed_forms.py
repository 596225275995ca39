"""Lock and break-away times, speeds and heat against closed forms.

Every event time is held to 1e-9 s (what the specification asks for). The runs use rtol 1e-12, so that the tolerance
speaks about event location and mode logic. Speeds and heat are held to 1e-9 of their size for the same reason.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import clutchwork as cw
from support.runs import TIGHT, assert_switches, at_end, clutch, over, switches

METHODS = ("rodas5p", "dopri5")


@pytest.mark.parametrize("method", METHODS)
def test_two_discs_engage(method: str) -> None:
    """The slip of 100 rad/s falls with 10/0.2 + 10/0.8 = 62.5 rad/s2; half of 1000 J goes where the rest does not."""
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    d.add(clutch("c", engine, load, kinetic=10.0))
    run = d.simulate(2.0, method=method, **TIGHT)
    assert_switches(run, [(1.6, "c", "backward", "locked")])
    assert at_end(run, "engine.speed") == pytest.approx(20.0, rel=1e-12)
    assert at_end(run, "c.heat") == pytest.approx(800.0, rel=1e-9)
    # the slip of a locked contact is exactly zero
    assert np.all(run["c.slip"][run["c.mode"] == 0] == 0.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_break_away_under_a_ramp(sign: float) -> None:
    """Torque 40 t on 0.3 kg m2, 0.5 kg m2 behind the clutch: it carries 5/8 of it and lets go at 12 N m."""
    d = cw.Driveline("ramp")
    a, b = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.5)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table([(0.0, 0.0), (10.0, sign * 400.0)])))
    d.add(clutch("c", b, a, static=12.0, kinetic=8.0))
    run = d.simulate(1.0, **TIGHT)
    start = 12.0 / (40.0 * 5 / 8)
    assert_switches(run, [(start, "c", "locked", "forward" if sign > 0 else "backward")])
    # b is driven by the kinetic 8 N m afterwards
    before = 20.0 * start**2 / 0.8
    assert at_end(run, "b.speed") == pytest.approx(sign * (before + 8.0 / 0.5 * (1.0 - start)), rel=1e-9)


def test_torque_reverses_through_zero_while_locked() -> None:
    """30 sin(2 pi 3 t) on a, capacity 20 > 30 * 0.5/0.8 = 18.75: the multiplier follows and nothing happens."""
    d = cw.Driveline("reversal")
    a, b = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.5)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=30.0, frequency=3.0)))
    d.add(clutch("c", b, a, kinetic=20.0))
    run = d.simulate(1.0, dt=0.01, **TIGHT)
    assert switches(run) == []
    expected = -18.75 * np.sin(6 * math.pi * run.time)
    # round-off of a few operations on 20 N m
    assert np.max(np.abs(run["c.torque"] - expected)) < 1e-12 * 100
    assert np.all(run["c.slip"] == 0.0)


def test_break_away_under_a_sine() -> None:
    """A sin(2 pi f t) reaches the capacity at asin(T/A)/(2 pi f)."""
    d = cw.Driveline("sine")
    a = d.shaft("a", inertia=0.3)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=30.0, frequency=2.0)))
    d.add(clutch("b", d.housing, a, static=21.0, kinetic=15.0))
    run = d.simulate(0.1, **TIGHT)
    assert_switches(run, [(math.asin(0.7) / (4 * math.pi), "b", "locked", "forward")])


def test_brake_to_rest_and_hold() -> None:
    """(40 - 15) N m slow 0.5 kg m2 from 30 rad/s; then the brake holds 15 N m."""
    d = cw.Driveline("brake")
    a = d.shaft("a", inertia=0.5, speed=30.0)
    d.add(cw.Torque("drive", shaft=a, torque=15.0))
    law = cw.Coulomb(static=0.5, kinetic=0.4)
    d.add(cw.Brake("b", shaft=a, friction=law, gain=1e-4, pressure=1e6))
    run = d.simulate(1.0, **TIGHT)
    assert_switches(run, [(0.5 * 30 / 25, "b", "forward", "locked")])
    assert at_end(run, "a.speed") == 0.0
    assert at_end(run, "b.torque") == pytest.approx(-15.0, rel=1e-12)
    assert at_end(run, "a.angle") == pytest.approx(0.5 * 30 * 0.6, rel=1e-9)
    # brake and drive both rest on the housing, which gets nothing in sum
    assert at_end(run, "housing.torque") == pytest.approx(0.0, abs=1e-12)


def test_slip_passes_zero_and_turns_round() -> None:
    """Drive -60 N m against a brake of 40: -100 before zero, -20 after."""
    d = cw.Driveline("through zero")
    a = d.shaft("a", inertia=0.5, speed=30.0)
    d.add(cw.Torque("drive", shaft=a, torque=-60.0))
    d.add(clutch("b", d.housing, a, kinetic=40.0))
    run = d.simulate(0.5, **TIGHT)
    assert_switches(run, [(0.15, "b", "forward", "backward")])
    assert at_end(run, "a.speed") == pytest.approx(-20.0 / 0.5 * 0.35, rel=1e-9)


def test_chain_of_three_clutches_locks_one_after_the_other() -> None:
    """Discs of 1, 2, 3 kg m2 and the housing; capacities 12, 6, 18 N m; worked out by hand, phase by phase.

    0: speeds (24, 0, 0): T1 = 12 on the second, T2 = 6 on the third, T3 holds the third (6 < 18).
       accelerations (-12, 3, 0): slip 24 falls with 15: c1 locks at 1.6 s, common speed 4.8 rad/s.
    1: T2 = 6 against 3 kg m2: acceleration -2: c2 locks at 1.6 + 2.4 = 4.0 s, all at rest.
    """
    d = cw.Driveline("chain")
    s = [d.shaft("s1", inertia=1.0, speed=24.0), d.shaft("s2", inertia=2.0), d.shaft("s3", inertia=3.0)]
    d.add(clutch("c1", s[1], s[0], kinetic=12.0))
    d.add(clutch("c2", s[2], s[1], kinetic=6.0))
    d.add(clutch("c3", d.housing, s[2], kinetic=18.0))
    run = d.simulate(5.0, **TIGHT)
    assert_switches(run, [(1.6, "c1", "forward", "locked"), (4.0, "c2", "forward", "locked")])
    # heat: 12 * 24 * 1.6 / 2 and 6 * (3 * 1.6^2 / 2 + 4.8 * 2.4 / 2)
    assert at_end(run, "c1.heat") == pytest.approx(230.4, rel=1e-9)
    assert at_end(run, "c2.heat") == pytest.approx(57.6, rel=1e-9)
    assert at_end(run, "c3.heat") == 0.0


def test_chain_breaks_away_at_its_weakest_clutch() -> None:
    """Ramp 10 t on the first of three locked discs 1, 2, 3: c1 carries 5/6, c2 3/6 of it.

    c2 (4 N m) lets go at 0.8 s; then c1 carries 2/3 of (10 t - 3) + 3 and reaches 9 N m at 1.2 s.
    """
    d = cw.Driveline("weakest")
    s = [d.shaft(f"s{i}", inertia=float(i)) for i in (1, 2, 3)]
    d.add(cw.Torque("drive", shaft=s[0], torque=cw.Table([(0.0, 0.0), (10.0, 100.0)])))
    d.add(clutch("c1", s[1], s[0], static=9.0, kinetic=9.0))
    d.add(clutch("c2", s[2], s[1], static=4.0, kinetic=3.0))
    run = d.simulate(1.5, **TIGHT)
    assert_switches(run, [(0.8, "c2", "locked", "forward"), (1.2, "c1", "locked", "forward")])


def test_two_clutches_lock_at_one_instant() -> None:
    """A spinning disc between two equal ones at rest: both slips end together."""
    d = cw.Driveline("two at once")
    left, middle, right = d.shaft("l", inertia=0.4), d.shaft("m", inertia=0.5, speed=50.0), d.shaft("r", inertia=0.4)
    d.add(clutch("c1", middle, left, kinetic=10.0))
    d.add(clutch("c2", middle, right, kinetic=10.0))
    run = d.simulate(1.0, **TIGHT)
    lock = 50.0 / (20.0 / 0.5 + 10.0 / 0.4)
    assert_switches(run, [(lock, "c1", "backward", "locked"), (lock, "c2", "backward", "locked")])
    assert switches(run)[0][0] == switches(run)[1][0]
    assert at_end(run, "l.speed") == pytest.approx(50.0 * 0.5 / 1.3, rel=1e-12)


def test_pressure_ramp() -> None:
    """Capacity 20 t against 0.4 kg m2 at 30 rad/s: 10 t^2 = 12."""
    d = cw.Driveline("pressure ramp")
    a = d.shaft("a", inertia=0.4, speed=30.0)
    d.add(cw.Clutch("b", base=d.housing, follower=a, **over([(0.0, 0.0), (5.0, 100.0)])))
    run = d.simulate(2.0, **TIGHT)
    assert_switches(run, [(math.sqrt(1.2), "b", "forward", "locked")])


def test_falling_pressure_lets_go() -> None:
    """100 - 40 t reaches the load of 30 N m at 1.75 s with static coefficient 1, kinetic 0.8."""
    d = cw.Driveline("falling pressure")
    a = d.shaft("a", inertia=0.4)
    d.add(cw.Torque("drive", shaft=a, torque=30.0))
    d.add(cw.Clutch("b", base=d.housing, follower=a, **over([(0.0, 100.0), (2.5, 0.0)], static=1.0, kinetic=0.8)))
    run = d.simulate(2.0, **TIGHT)
    assert_switches(run, [(1.75, "b", "locked", "forward")])
    # 30 - 0.8 (100 - 40 t) from 1.75 to 2.0 s: 6 N m at the start, 14 at the end
    assert at_end(run, "a.speed") == pytest.approx(0.5 * (6.0 + 14.0) * 0.25 / 0.4, rel=1e-9)


def test_viscous_drag_and_brake() -> None:
    """J dw/dt = -T - d w comes to rest at (J/d) log(1 + d w0/T)."""
    d = cw.Driveline("viscous")
    a = d.shaft("a", inertia=0.7, speed=80.0)
    d.add(cw.Damper("drag", base=d.housing, follower=a, damping=0.9))
    d.add(clutch("b", d.housing, a, kinetic=12.0))
    run = d.simulate(3.0, **TIGHT)
    assert_switches(run, [(0.7 / 0.9 * math.log1p(0.9 * 80 / 12), "b", "forward", "locked")])


def test_quadratic_drag_and_brake() -> None:
    """J dw/dt = -T - q w^2 comes to rest at J/sqrt(T q) atan(w0 sqrt(q/T))."""
    d = cw.Driveline("quadratic")
    a = d.shaft("a", inertia=0.7, speed=80.0)
    d.add(cw.QuadraticTorque("drag", shaft=a, nominal_torque=-25.0, nominal_speed=50.0))
    d.add(clutch("b", d.housing, a, kinetic=12.0))
    run = d.simulate(5.0, **TIGHT)
    q = 25.0 / 50.0**2
    assert_switches(run, [(0.7 / math.sqrt(12 * q) * math.atan(80 * math.sqrt(q / 12)), "b", "forward", "locked")])


def test_exponential_friction_law() -> None:
    """ds/dt = -(a + b exp(-s/v))/J locks at J v/a log((a exp(s0/v) + b)/(a + b))."""
    d = cw.Driveline("exponential")
    a = d.shaft("a", inertia=0.6, speed=90.0)
    law = cw.Exponential(static=0.16, slow=0.14, fast=0.065, speed=12.5)
    d.add(cw.Clutch("b", base=d.housing, follower=a, friction=law, gain=0.01, pressure=2e4))
    run = d.simulate(5.0, **TIGHT)
    far, near = 200 * 0.065, 200 * (0.14 - 0.065)
    lock = 0.6 * 12.5 / far * math.log((far * math.exp(90 / 12.5) + near) / (far + near))
    assert_switches(run, [(lock, "b", "forward", "locked")])


def test_coefficient_table() -> None:
    """mu = 0.1 + 0.002 s up to 50 rad/s, 0.2 above: first linear in time, then logarithmic."""
    d = cw.Driveline("table law")
    a = d.shaft("a", inertia=0.6, speed=90.0)
    law = cw.CoefficientTable(static=0.1, kinetic=[(0.0, 0.1), (50.0, 0.2), (100.0, 0.2)])
    d.add(cw.Clutch("b", base=d.housing, follower=a, friction=law, gain=1.0, normal_force=200.0))
    run = d.simulate(3.0, **TIGHT)
    lock = 0.6 * 40 / 40 + 0.6 / 0.4 * math.log(1 + 0.4 * 50 / 20)
    assert_switches(run, [(lock, "b", "forward", "locked")])


def test_stick_slip_on_a_belt() -> None:
    """A mass pulled through a spring: static 1.5, kinetic 1.0; the closed cycle of stick and slip.

    Sticks until c v t = Fs; slips with x'' + w^2 x = ..., for (2/w)(pi - atan(u)), u = (Fs - Fk) w/(c v); sticks for
    2 (Fs - Fk)/(c v); and so on for ever, the same.
    """
    stiffness, speed, mass, hold, slide = 40.0, 0.5, 0.8, 15.0, 10.0
    d = cw.Driveline("belt")
    puller, block = d.mass("puller", mass=1.0, speed=speed), d.mass("block", mass=mass)
    d.add(cw.PrescribedSpeed("pull", shaft=puller, speed=speed))
    d.add(cw.Spring("spring", base=puller, follower=block, stiffness=stiffness))
    d.add(clutch("floor", d.housing, block, static=hold, kinetic=slide))
    run = d.simulate(12.0, **TIGHT)
    omega = math.sqrt(stiffness / mass)
    slip = 2 / omega * (math.pi - math.atan((hold - slide) * omega / (stiffness * speed)))
    stick = 2 * (hold - slide) / (stiffness * speed)
    expected, t = [], hold / (stiffness * speed)
    while t < 12.0:
        expected.append((t, "floor", "locked", "forward"))
        if t + slip < 12.0:
            expected.append((t + slip, "floor", "forward", "locked"))
        t += slip + stick
    assert len(expected) > 10
    assert_switches(run, expected)


def test_freewheel_overruns_engages_and_lets_go() -> None:
    """Driver 0.2 kg m2 under 6 N m, then -4 N m from 2 s; load 0.8 kg m2 at 20 rad/s with a drag of 2 N m.

    Slip 20 falls with 30 + 2.5: engaged at 20/32.5 s. Together (6 - 2)/1.0. From 2 s the driver alone would fall
    faster (-20 against -2.5): it lets go there at once.
    """
    d = cw.Driveline("freewheel")
    driver, load = d.shaft("driver", inertia=0.2), d.shaft("load", inertia=0.8, speed=20.0)
    d.add(cw.OneWayClutch("f", base=driver, follower=load))
    d.add(cw.Torque("drive", shaft=driver, torque=cw.Table([(0.0, 6.0), (2.0, 6.0), (2.0, -4.0)])))
    d.add(cw.Torque("drag", shaft=load, torque=-2.0))
    run = d.simulate(3.0, times=[0.0, 0.4, 1.0, 2.5, 3.0], **TIGHT)
    engaged = 20.0 / 32.5
    changed = run.events.of("f").changes()
    changed = [e for e in changed if "locked" in (e.before, e.after)]
    assert [e.after == "locked" for e in changed] == [True, False]
    assert changed[0].time == pytest.approx(engaged, abs=1e-9)
    assert changed[1].time == pytest.approx(2.0, abs=1e-9)
    # acceleration 4 rad/s2: the load gets 0.8 * 4 + 2
    assert run["f.torque"] == pytest.approx([0.0, 0.0, 5.2, 0.0, 0.0], abs=1e-9)
    together = 20.0 - 2.5 * engaged + 4.0 * (2.0 - engaged)
    assert run["load.speed"][-1] == pytest.approx(together - 2.5, rel=1e-9)
    assert run["driver.speed"][-1] == pytest.approx(together - 20.0, rel=1e-9)


def test_freewheel_lets_go_where_its_torque_passes_zero() -> None:
    """Drive 10 - 10 t on one of two equal discs, load -2: the freewheel carries (10 - 10 t + 2)/2: zero at 1.2 s."""
    d = cw.Driveline("freewheel ramp")
    driver, load = d.shaft("driver", inertia=0.5), d.shaft("load", inertia=0.5)
    d.add(cw.OneWayClutch("f", base=driver, follower=load))
    d.add(cw.Torque("drive", shaft=driver, torque=cw.Table([(0.0, 10.0), (2.0, -10.0)])))
    d.add(cw.Torque("drag", shaft=load, torque=-2.0))
    run = d.simulate(1.5, **TIGHT)
    changed = [e for e in run.events.of("f").changes() if e.time > 0]
    assert [(e.before, e.after == "locked") for e in changed] == [("locked", False)]
    assert changed[-1].time == pytest.approx(1.2, abs=1e-9)


def test_planetary_set_shifts_by_its_ring_brake() -> None:
    """Sun driven, ring braked, carrier out; k = 2: ws + 2 wr = 3 wc, so wr = (3 wc - ws)/2; braked wc = ws/3."""
    J = {"sun": 0.1, "ring": 0.2, "carrier": 0.9}
    d = cw.Driveline("planetary")
    sun, ring = d.shaft("sun", inertia=J["sun"], speed=60.0), d.shaft("ring", inertia=J["ring"], speed=-30.0)
    carrier = d.shaft("carrier", inertia=J["carrier"])
    d.add(cw.Planetary("p", sun=sun, ring=ring, carrier=carrier, ratio=2.0))
    d.add(cw.Torque("drive", shaft=sun, torque=5.0))
    d.add(clutch("b", d.housing, ring, kinetic=25.0))
    run = d.simulate(1.0, **TIGHT)
    # by hand: M = [[Js + Jr/4, -3 Jr/4], [-3 Jr/4, Jc + 9 Jr/4]], Q = (5, 0) + 25 (-1/2, 3/2)
    M = np.array([[0.15, -0.15], [-0.15, 1.35]])
    a = np.linalg.solve(M, np.array([5.0, 0.0]) + 25.0 * np.array([-0.5, 1.5]))
    lock = 30.0 / ((3 * a[1] - a[0]) / 2)
    assert_switches(run, [(lock, "b", "backward", "locked")])
    # then one inertia at the sun: Js + Jc/9
    speed = 60.0 + a[0] * lock
    assert at_end(run, "sun.speed") == pytest.approx(speed + 5.0 / 0.2 * (1.0 - lock), rel=1e-9)
    assert at_end(run, "carrier.speed") == pytest.approx(at_end(run, "sun.speed") / 3, rel=1e-12)
    # carrier gets J dw/dt = 0.9 * 25/3 = 7.5 N m through the set: sun 2.5, ring 5, held by the brake
    assert at_end(run, "b.torque") == pytest.approx(5.0, rel=1e-9)


def test_double_pinion_planetary() -> None:
    """k wr - ws = (k - 1) wc with k = 2 and the carrier held: ws = 2 wr; torque balance of the locked set."""
    d = cw.Driveline("double pinion")
    sun, ring = d.shaft("sun", inertia=0.1), d.shaft("ring", inertia=0.6)
    carrier = d.shaft("carrier", inertia=0.3)
    d.add(cw.DoublePlanetary("p", sun=sun, ring=ring, carrier=carrier, ratio=2.0))
    d.add(cw.Torque("drive", shaft=sun, torque=cw.Table([(0.0, 0.0), (1.0, 8.0)])))
    d.add(clutch("b", d.housing, carrier, static=3.0, kinetic=2.0))
    run = d.simulate(0.9, **TIGHT)
    # held: ws = 2 wr, inertia at the sun 0.1 + 0.6/4 = 0.25; dws/dt = 32 t; ring gets 0.6 * 16 t = 9.6 t, the set
    # passes tau_s = 8 t - 3.2 t = 4.8 t into the sun, ring 2 tau_s, so the carrier holds tau_c = (k - 1) tau_s = 4.8 t
    assert_switches(run, [(3.0 / 4.8, "b", "locked", "backward")])


def test_clutch_behind_a_gear() -> None:
    """Input 0.1 kg m2 at 90 rad/s over 3:1 to 0.3 kg m2, then a clutch of 14 N m to 1.2 kg m2 at rest."""
    d = cw.Driveline("gear")
    a, b, c = d.shaft("a", inertia=0.1, speed=90.0), d.shaft("b", inertia=0.3, speed=30.0), d.shaft("c", inertia=1.2)
    d.add(cw.Gear("g", input=a, output=b, ratio=3.0))
    d.add(clutch("k", b, c, kinetic=14.0))
    run = d.simulate(2.0, **TIGHT)
    assert_switches(run, [(30.0 / (14.0 / 1.2 + 14.0 / 1.2), "k", "backward", "locked")])
    assert at_end(run, "c.speed") == pytest.approx(15.0, rel=1e-12)


def test_translation_stops_on_friction() -> None:
    """A mass of 3 kg at 6 m/s under 4.5 N of friction: 4 s and 12 m."""
    d = cw.Driveline("sliding mass")
    block = d.mass("block", mass=3.0, speed=6.0, position=1.0)
    d.add(cw.BearingFriction("floor", shaft=block, friction=cw.Coulomb(static=1.2, kinetic=1.0), torque=4.5))
    run = d.simulate(5.0, **TIGHT)
    assert_switches(run, [(4.0, "floor", "forward", "locked")])
    assert at_end(run, "block.position") == pytest.approx(13.0, rel=1e-12)


def test_rolling_wheel() -> None:
    """A wheel of 0.3 m on 50 kg under a brake of 60 N m: (50 0.09 + 0.5) kg m2 at the shaft, 40 rad/s."""
    d = cw.Driveline("wheel")
    wheel, car = d.shaft("wheel", inertia=0.5, speed=40.0), d.mass("car", mass=50.0, speed=12.0)
    d.add(cw.RollingWheel("tyre", shaft=wheel, mass=car, radius=0.3))
    d.add(clutch("b", d.housing, wheel, kinetic=60.0))
    run = d.simulate(4.0, **TIGHT)
    assert_switches(run, [(5.0 * 40.0 / 60.0, "b", "forward", "locked")])
    assert at_end(run, "car.position") == pytest.approx(0.5 * 12.0 * 10 / 3, rel=1e-12)


def test_prescribed_speed_drags_a_disc_along() -> None:
    """Shaft at 30 t rad/s up to 1 s, then 30 + 80 (t - 1); disc 0.5 kg m2 at 12 rad/s; clutch 18, static 25 N m.

    The disc is ahead and loses 36 rad/s2 while the shaft gains 30: it locks at 12/66 s and is held with 15 N m.
    From 1 s on 40 N m would be needed: it breaks away there.
    """
    d = cw.Driveline("prescribed")
    shaft, disc = d.shaft("shaft", inertia=0.1), d.shaft("disc", inertia=0.5, speed=12.0)
    d.add(cw.PrescribedSpeed("p", shaft=shaft, speed=cw.Table([(0.0, 0.0), (1.0, 30.0), (2.0, 110.0)])))
    d.add(clutch("c", shaft, disc, static=25.0, kinetic=18.0))
    run = d.simulate(1.5, times=[0.0, 0.1, 0.5, 1.2, 1.5], **TIGHT)
    assert_switches(run, [(12.0 / 66.0, "c", "forward", "locked"), (1.0, "c", "locked", "backward")])
    assert run["c.torque"] == pytest.approx([-18.0, -18.0, 15.0, 18.0, 18.0], rel=1e-12)
    # torque of the source: own inertia and the reaction of the clutch
    assert run["p.torque"] == pytest.approx([-15.0, -15.0, 18.0, 26.0, 26.0], rel=1e-9)
    assert run["disc.speed"][-1] == pytest.approx(30.0 + 36.0 * 0.5, rel=1e-12)


def test_clutch_between_two_prescribed_shafts() -> None:
    """No freedom is left: slip 5 - 10 t changes its sign at 0.5 s without sticking."""
    d = cw.Driveline("two prescribed")
    a, b = d.shaft("a", inertia=0.1), d.shaft("b", inertia=0.1)
    d.add(cw.PrescribedSpeed("pa", shaft=a, speed=7.0))
    d.add(cw.PrescribedSpeed("pb", shaft=b, speed=cw.Table([(0.0, 12.0), (1.0, 2.0)])))
    d.add(clutch("c", a, b, kinetic=18.0))
    run = d.simulate(1.0, times=[0.2, 0.8], **TIGHT)
    assert_switches(run, [(0.5, "c", "forward", "backward")])
    assert run["c.torque"] == pytest.approx([-18.0, 18.0], rel=1e-12)


def test_locking_impulse_loses_the_known_energy() -> None:
    """Locked at the start with 10 and 0 rad/s: common speed by momentum, half the reduced inertia times slip^2 lost."""
    d = cw.Driveline("impulse")
    a, b = d.shaft("a", inertia=0.2, speed=10.0), d.shaft("b", inertia=0.3)
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1.0, normal_force=50.0, locked=True))
    run = d.simulate(0.1, **TIGHT)
    # 1e-12: round-off of the projection
    assert at_end(run, "a.speed") == pytest.approx(4.0, rel=1e-12)
    assert at_end(run, "b.speed") == pytest.approx(4.0, rel=1e-12)
    assert run.energy.impulses == pytest.approx(0.5 * 0.2 * 0.3 / 0.5 * 100, rel=1e-12)


def test_parallel_brakes_hold_the_sum_of_their_capacities() -> None:
    """Brakes of 10 and 20 N m on one shaft under 5 t: both let go at 6 s (one at a time: at 2 s)."""
    d = cw.Driveline("parallel brakes")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table([(0.0, 0.0), (10.0, 50.0)])))
    d.add(clutch("b1", d.housing, a, kinetic=10.0))
    d.add(clutch("b2", d.housing, a, kinetic=20.0))
    run = d.simulate(7.0, dt=0.5, **TIGHT)
    moved = [s for s in switches(run) if s[3] == "forward"]
    assert [s[1] for s in moved] == ["b1", "b2"]
    assert [s[0] for s in moved] == pytest.approx([6.0, 6.0], abs=1e-9)
    still = run.time < 6.0
    assert np.all(run["a.speed"][still] == 0.0)
    total = run["b1.torque"] + run["b2.torque"]
    assert total[still] == pytest.approx(-5 * run.time[still], abs=1e-9)
    assert at_end(run, "a.speed") == pytest.approx(2.5, rel=1e-9)


def test_parallel_brakes_behind_a_gear() -> None:
    """A brake of 10 N m on the input and one of 12 on the output of 3:1 hold 10 + 12/3 = 14 N m at the input."""
    d = cw.Driveline("geared brakes")
    a, b = d.shaft("a", inertia=0.2), d.shaft("b", inertia=0.9)
    d.add(cw.Gear("g", input=a, output=b, ratio=3.0))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table([(0.0, 0.0), (10.0, 50.0)])))
    d.add(clutch("b1", d.housing, a, kinetic=10.0))
    d.add(clutch("b2", d.housing, b, kinetic=12.0))
    run = d.simulate(4.0, **TIGHT)
    moved = [s for s in switches(run) if s[3] == "forward"]
    assert [s[0] for s in moved] == pytest.approx([2.8, 2.8], abs=1e-9)
    assert at_end(run, "a.speed") == pytest.approx(2.5 * 1.2**2 / 0.3, rel=1e-9)


def test_break_away_of_one_makes_another_lock() -> None:
    """Brake b1 (static 20, kinetic 5 N m) holds a (1 kg m2) against a drive of 30 t and clutch c (8 N m) until 0.4 s.

    b (1 kg m2) turns at a steady 2 rad/s: 8 N m drive it, c takes 8 N m. Freed, a gains 30 t + 8 - 5 and meets b, so
    that c locks where 15 (t^2 - 0.16) + 3 (t - 0.4) = 2.
    """
    d = cw.Driveline("hand over")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0, speed=2.0)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Table([(0.0, 0.0), (10.0, 300.0)])))
    d.add(cw.Torque("keep", shaft=b, torque=8.0))
    d.add(clutch("b1", d.housing, a, static=20.0, kinetic=5.0))
    d.add(clutch("c", a, b, static=50.0, kinetic=8.0))
    run = d.simulate(0.6, **TIGHT)
    meet = (-3 + math.sqrt(9 + 60 * (15 * 0.16 + 1.2 + 2.0))) / 30
    assert_switches(run, [(0.4, "b1", "locked", "forward"), (meet, "c", "forward", "locked")])
