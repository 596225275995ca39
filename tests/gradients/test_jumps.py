"""Derivatives behind signals that jump, that repeat, or that jump by nothing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import expm

import clutchwork as cw

TIGHT: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-12}
SIDES = ("left", "right")


def central(f: cw.Differentiable, step: float) -> np.ndarray:
    """Differences of fourth order of all values by the only number."""
    x = f.x0
    found: np.ndarray = (f(x - 2 * step) - 8 * f(x - step) + 8 * f(x + step) - f(x + 2 * step)) / (12 * step)
    return found


@pytest.mark.parametrize("t_end", [0.15, 0.45])
def test_a_load_that_is_zero_between_pulses(t_end: float) -> None:
    """A little more presses before the first pulse and between pulses, a little less does not."""
    d = cw.Driveline("pulses")
    a = d.shaft("a", inertia=0.5, speed=40.0)
    load = cw.Pulse(height=20.0, period=0.2, width=0.05, start=0.1)
    d.add(cw.Brake("brake", shaft=a, friction=cw.Coulomb(static=0.3, kinetic=0.3), gain=1.0, normal_force=load))
    pulses = np.clip(t_end - np.array([0.1, 0.3]), 0.0, 0.05).sum()
    # decelerated by friction over inertia: all the time, or in pulses alone
    for side, pressed in (("right", t_end), ("left", pulses)):
        f = cw.differentiable(d, t_end, of="a.speed", by="brake.normal_force.offset", side=side, **TIGHT)
        assert f.gradient().matrix[0, 0] == pytest.approx(-0.3 * pressed / 0.5, rel=1e-7)
    with pytest.raises(cw.NoGradient, match=r"normal_force is 0 from 0 to 0\.1 s"):
        cw.differentiable(d, t_end, of="a.speed", by="brake.normal_force.offset", **TIGHT).gradient()


@pytest.mark.parametrize("height", [0.0, 0.1])
@pytest.mark.parametrize("inertia", [0.01, 0.0])
def test_a_ratio_that_jumps_by_nothing(height: float, inertia: float) -> None:
    """Speeds follow the ratio that another number would give, and so does what they wind up."""
    d = cw.Driveline("ratio")
    a, b = d.shaft("a", inertia=0.0177, speed=3.0), d.shaft("b", inertia=inertia)
    d.add(cw.Spring("spring", base=a, follower=b, stiffness=377.5, initial_twist=0.01))
    ratio = cw.Step(height=height, start=0.01, offset=1.013)
    d.add(cw.VariableGear("gear", input=b, output=a, ratio=ratio))
    f = cw.differentiable(d, 0.03, of=["a.speed", "spring.torque"], by="gear.ratio.height", **TIGHT)
    # differences of a tight run at a step of 1e-4 have about eight digits
    np.testing.assert_allclose(f.gradient().matrix[:, 0], central(f, 1e-4), rtol=1e-6)


def test_squared_jerk_of_a_prescribed_motion_by_the_instant_at_which_it_begins() -> None:
    """The motion is exact in steps of any length, and its jerk is not that of polynomials over such steps.

    A position that jumps passes a Bessel filter; later by one second the integral lacks the last square of the jerk.
    """
    height, start, end, rate = 0.0673, 0.04, 0.0542, 2 * np.pi * 31.9
    d = cw.Driveline("filtered")
    a = d.shaft("a", inertia=1.0)
    position = cw.Step(height=height, start=start)
    d.add(cw.PrescribedPosition("motion", shaft=a, position=position, cutoff=31.9))
    slope = np.array([[0.0, 1.0], [-(rate**2) / 0.618, -1.3617 * rate / 0.618]])

    def jerk(time: float) -> float:
        return float((slope @ slope @ expm(slope * time) @ [-height, 0.0])[1])

    found = cw.differentiable(d, end, of=cw.squared_jerk("a"), by="motion.position.start", **TIGHT).gradient()
    whole = quad(lambda time: jerk(time) ** 2, 0.0, end - start, epsrel=1e-10)[0]
    assert found.values[0] == pytest.approx(whole, rel=1e-5)
    # the first jerk is 30 times the last one, so its square is lost to a part in a thousand of a polynomial
    assert found.matrix[0, 0] == pytest.approx(-(jerk(end - start) ** 2), rel=1e-3)


def test_a_peak_among_steps_that_grow_behind_a_jump() -> None:
    """Where the derivative of a torque changes fast, the instant of its peak must be known to a share of a step."""
    # seed 110182
    d = cw.Driveline("tyre")
    a, m = d.shaft("a", inertia=0.127), d.mass("m", mass=60.0)
    sun, ring = d.shaft("sun", inertia=0.522), d.shaft("ring", inertia=0.00559)
    load = cw.Ramp(height=6156.0, duration=0.0355266, start=0.07856, offset=-4657.0)
    d.add(cw.Torque("drive", shaft=m, torque=-0.7828))
    d.add(cw.DoublePlanetary("planets", sun=sun, ring=ring, carrier=a, ratio=1.41))
    lower = cw.Sine(amplitude=32.06, frequency=10.62, offset=163.4, damping=0.532)
    d.add(cw.FundamentalClutch("held", base=d.housing, follower=a, kinetic=0.01359, upper=168.0, lower=lower))
    d.add(cw.PrescribedAcceleration("motion", shaft=ring, acceleration=-13.4))
    d.add(cw.Tyre("tyre", shaft=a, mass=m, radius=0.307, load=load, E=-0.182, low_speed_damping=4560.0))
    f = cw.differentiable(d, 0.2, of=cw.peak("held.torque"), by="tyre.load.duration", **TIGHT)
    scale = f.gradient().values[0] / 0.0355266
    np.testing.assert_allclose(f.gradient().matrix[0], central(f, 1e-6), atol=1e-6 * scale)


def test_a_jerk_within_a_nanosecond_has_no_derivatives() -> None:
    """Runs with derivatives do not look into such short steps, and say so."""
    d = cw.Driveline("nanosecond")
    a = d.shaft("a", inertia=1e-9, speed=1e-3)
    d.add(cw.Damper("damper", base=d.housing, follower=a, damping=100.0))
    of = [cw.squared_jerk("a"), "a.speed"]
    found = cw.differentiable(d, 0.1, of=of, by="damper.damping", **TIGHT).gradient()
    assert np.isnan(found.matrix[0, 0])
    assert np.isfinite(found.matrix[1, 0])
    assert "settles within a few nanoseconds" in found.problems[0]


def test_two_borders_of_an_element_that_are_passed_at_one_instant() -> None:
    """The throttle of the idle control leaves its end and that of the table of torques: each by its own slope."""
    # seed 120008: between both the least of the guards has its top, whose slope is zero
    d = cw.Driveline("engine")
    a = d.shaft("a", inertia=0.282, speed=20.0)
    torques = {"full_load": [(0.0, 398.0), (138.0, 285.0)], "motoring": [(0.0, -53.6), (138.0, -30.2)]}
    idle = {"idle_speed": 49.1, "idle_gain": 0.0816, "idle_integral": 0.0268}
    # a throttle beyond the table, from which the idle control takes over at its end
    throttle = cw.Step(height=-1.5, start=0.005, offset=2.4)
    d.add(cw.Engine("engine", shaft=a, throttle=throttle, **torques, **idle))
    of = ["a.speed", "engine.work"]
    f = cw.differentiable(d, 0.1, of=of, by="engine.full_load.values[1]", **TIGHT)
    assert abs(f(f.x0)[0] - 20.0) > 10.0
    np.testing.assert_allclose(f.gradient().matrix[:, 0], central(f, 0.1), rtol=1e-6)


@pytest.mark.parametrize("request_", [0.0, 1.0])
def test_a_motor_whose_limit_jumps_as_it_passes_rest(request_: float) -> None:
    """What it may drive with is more than what it may brake with: the limit jumps with the speed, not by itself."""
    # seed 120141
    d = cw.Driveline("swings")
    a = d.shaft("a", inertia=0.263, speed=-2.93)
    d.add(cw.Spring("spring", base=d.housing, follower=a, stiffness=27500.0))
    brakes = [(0.5331, 3.5), (1.585, 0.597), (3.876, 6.41), (4.9, 0.313)]
    limits = {"max_torque": [(0.0, 31.1), (152.0, 12.4)], "generator_torque": brakes}
    d.add(cw.ElectricMotor("motor", shaft=a, command=13.9, lag=0.0644, initial_request=request_, **limits))
    f = cw.differentiable(d, 0.05, of=["a.speed", "spring.twist"], by="motor.initial_request", **TIGHT)
    # differences over 1 mN m of values of a tight run have about five digits
    np.testing.assert_allclose(f.gradient().matrix[:, 0], central(f, 1e-3), rtol=1e-4)


def test_a_contact_that_breaks_away_from_nothing_beside_a_border() -> None:
    """Before the border its torque has the other sign, so a slope over both sides of it says nothing."""
    # seed 150270
    d = cw.Driveline("from nothing")
    sun, support, out = (d.shaft(name, inertia=j) for name, j in (("in", 0.01), ("crank", 0.7), ("out", 0.022)))
    nut, other = d.mass("nut", mass=18.9), d.mass("other", mass=21.8)
    points = [[0.02209, -1.824], [0.05773, 0.5258], [0.1225, 1.376]]
    curves = [[-0.2067, 1.978], [-0.2526, 2.526], [-0.4499, 1.868]]
    # round-off of it keeps the screw for a moment
    d.add(cw.Torque("drive", shaft=other, torque=12.3))
    d.add(cw.BevelGear("bevel", input=sun, output=out, support=support, teeth_input=51, teeth_output=38))
    throttle, ripple = cw.Table(points), {"orders": [2.0], "amplitudes": [0.5], "phases": [0.0]}
    grid = {"speeds": [0.0, 1.251, 4.17], "throttles": [0.0, 1.0], "torques": curves, "deficit": [0.0, 0.48, 0.81]}
    d.add(cw.EngineTorque("engine", shaft=support, throttle=throttle, **grid, **ripple))
    d.add(cw.Leadscrew("screw", screw=out, mass=nut, lead=0.007, radius=0.005, friction_coefficient=0.238))
    f = cw.differentiable(d, 0.15, of=cw.break_away("screw"), by="engine.throttle.values[1]", **TIGHT)
    # the throttle passes zero
    (begin, low), (end, high) = points[:2]
    assert f.gradient().values[0] == pytest.approx(begin - low * (end - begin) / (high - low), rel=1e-8)
    assert f.gradient().matrix[0, 0] == pytest.approx(-high * (end - begin) / (high - low) ** 2, rel=1e-6)


def test_a_signal_that_jumps_by_nothing_has_both_sides_there() -> None:
    """Its largest value is the larger one of both, each a number of its own."""
    d = cw.Driveline("by nothing")
    s = d.shaft("s", inertia=1.0)
    d.add(cw.Torque("t", shaft=s, torque=cw.Table([[0.0, 0.0], [1.0, 5.0], [1.0, 5.0], [2.0, 0.0]])))
    by = [f"t.torque.values[{place}]" for place in (1, 2, 3)]
    f = cw.differentiable(d, 2.0, of=cw.maximum("t.torque"), by=by, **TIGHT)
    assert f.gradient().matrix[0] == pytest.approx([0.0, np.nan, np.nan], abs=1e-9, nan_ok=True)
    sides = [cw.differentiable(d, 2.0, of=cw.maximum("t.torque"), by=by, side=side, **TIGHT) for side in SIDES]
    sides = [one.gradient().matrix[0] for one in sides]
    np.testing.assert_allclose(sides, [[0.0, 0.0, 0.0], [0.0, 1.0, 1.0]], atol=1e-9)
    # where it bends alone there is one derivative
    d = cw.Driveline("bends")
    d.add(cw.Torque("t", shaft=d.shaft("s", inertia=1.0), torque=cw.Table([[0.0, 0.0], [1.0, 5.0], [2.0, 0.0]])))
    found = cw.differentiable(d, 2.0, of=cw.maximum("t.torque"), by=by, **TIGHT).gradient()
    np.testing.assert_allclose(found.matrix[0], [0.0, 1.0, 0.0], atol=1e-9)


def test_the_jerk_behind_a_jump_by_nothing() -> None:
    """The acceleration that a jump of the signal makes is none of the jerk, and no bend that moves."""
    # seed 160006
    d = cw.Driveline("filtered")
    speed = cw.Table([[0.0008, 0.0], [0.0008, 0.0], [0.01, 1.1], [0.024, 0.0]])
    d.add(cw.PrescribedSpeed("motion", shaft=d.mass("m", mass=1.64), speed=speed, cutoff=1.12))
    by = [f"motion.speed.values[{place}]" for place in (1, 2, 3)]
    f = cw.differentiable(d, 0.05, of=cw.squared_jerk("m"), by=by, **TIGHT)
    known = [(f(f.x0 + step)[0] - f(f.x0 - step)[0]) / 2e-5 for step in 1e-5 * np.eye(3)]
    np.testing.assert_allclose(f.gradient().matrix[0], known, rtol=1e-5)


def test_an_extreme_within_nanoseconds_has_its_value_and_no_derivatives() -> None:
    d = cw.Driveline("nanosecond")
    a = d.shaft("a", inertia=1e-9, speed=1e-3)
    d.add(cw.Damper("damper", base=d.housing, follower=a, damping=100.0))
    f = cw.differentiable(d, 0.1, of=cw.peak("damper.torque"), by="damper.damping", **TIGHT)
    assert f(f.x0)[0] == pytest.approx(0.1, rel=1e-6)
    with pytest.raises(cw.NoGradient, match=r"peak\(damper.torque\) is reached in motion that settles"):
        f.gradient()


@pytest.mark.parametrize("speed", [1e-5, 5e-4, 0.1])
def test_no_other_extreme_stands_for_one_within_nanoseconds(speed: float) -> None:
    """While it slips, for 0.01 to 100 ps, the brake has more torque than it holds later."""
    d = cw.Driveline("another")
    s = d.shaft("s", inertia=1e-9, speed=speed)
    friction = cw.Coulomb(static=0.5, kinetic=0.4)
    d.add(cw.Brake("brake", shaft=s, friction=friction, gain=1.0, normal_force=2.0))
    d.add(cw.Torque("load", shaft=s, torque=cw.Table([[0.0, 0.0], [0.1, 0.3], [0.2, 0.0]])))
    f = cw.differentiable(d, 0.3, of=cw.peak("brake.torque"), by=["brake.gain", "load.torque.values[2]"], **TIGHT)
    assert f(f.x0)[0] == pytest.approx(0.8, rel=1e-9)
    with pytest.raises(cw.NoGradient, match=r"peak\(brake.torque\) is reached in motion that settles"):
        f.gradient()
    with pytest.raises(cw.NoGradient):
        f.vjp(f.x0, [1.0])


@pytest.mark.parametrize("side", SIDES)
def test_a_torque_that_is_zero_for_a_while_has_both_sides(side: str) -> None:
    """A negative one of a fundamental clutch counts as zero, so it brakes later alone."""
    d = cw.Driveline("fundamental")
    a, b = d.shaft("a", inertia=1.0, speed=10.0), d.shaft("b", inertia=1.0)
    kinetic = cw.Ramp(height=5.0, duration=0.1, start=0.2)
    d.add(cw.FundamentalClutch("c", base=b, follower=a, kinetic=kinetic, upper=20.0, lower=-20.0))
    f = cw.differentiable(d, 0.4, of="a.speed", by="c.kinetic.offset", side=side, **TIGHT)
    assert f.gradient().matrix[0, 0] == pytest.approx({"left": -0.2, "right": -0.4}[side], rel=1e-4)


@pytest.mark.parametrize("side", SIDES)
def test_a_flow_that_is_zero_for_a_while_has_both_sides(side: str) -> None:
    # seed 160227
    d = cw.Driveline("oil")
    d.shaft("s", inertia=1.0)
    plates, sump = d.thermal("plates", capacity=50.0, temperature=330.0), d.ambient("sump", temperature=290.0)
    d.add(cw.OilFlow("oil", hot=plates, inlet=sump, flow=cw.Ramp(height=0.01, duration=0.1, start=0.2)))
    f = cw.differentiable(d, 0.4, of=["plates.heat"], by="oil.flow.offset", **TIGHT)
    with pytest.raises(cw.NoGradient, match=r"oil\.flow is 0 from 0 to 0\.2 s, where a little more"):
        f.gradient()
    step = {"left": -1e-7, "right": 1e-7}[side]
    known = (f(f.x0 + step)[0] - f(f.x0)[0]) / step
    found = cw.differentiable(d, 0.4, of=["plates.heat"], by="oil.flow.offset", side=side, **TIGHT).gradient()
    assert found.matrix[0, 0] == pytest.approx(known, rel=1e-4)


def test_a_top_of_a_load_that_is_held_in_long_steps() -> None:
    """What is locked takes steps of any length, and its load has a top inside of one."""
    # seed 170202
    d = cw.Driveline("held")
    s = d.shaft("s", inertia=0.7)
    load = cw.Sine(amplitude=34.161, frequency=26.87, phase=2.81, offset=-101.5)
    d.add(cw.Torque("load", shaft=s, torque=load))
    friction = cw.Coulomb(static=0.139, kinetic=0.139)
    d.add(cw.Brake("brake", shaft=s, friction=friction, gain=1.0, normal_force=1e4))
    f = cw.differentiable(d, 0.0934, of=cw.peak("brake.torque"), by="load.torque.frequency", **TIGHT)
    assert f(f.x0)[0] == pytest.approx(135.661, rel=1e-10)
    assert abs(f.gradient().matrix[0, 0]) * 26.87 < 1e-7 * 135.661


@pytest.mark.parametrize("rtol", [1e-6, 1e-8])
def test_a_top_in_a_short_part_of_a_step_has_the_error_of_the_whole_one(rtol: float) -> None:
    # parts of one step agree to round-off and say nothing of what its dense output misses: 0.90 for -0.94 at 1e-6
    d = cw.Driveline("play")
    a, b, c = d.shaft("a", inertia=0.00428), d.shaft("b", inertia=0.00586), d.shaft("c", inertia=0.764)
    d.add(cw.Torque("t", shaft=b, torque=cw.Step(height=2.477, start=0.09238, offset=3.44)))
    d.add(cw.ElasticBacklash("play", base=b, follower=c, stiffness=10500.0, damping=27.9, gap=0.0095))
    force = cw.Pulse(height=-536.1, period=0.0954, width=0.02428, start=0.1317, offset=1435.0)
    friction = cw.Coulomb(static=0.1547, kinetic=0.111)
    cone = {"outer_diameter": 0.193, "inner_diameter": 0.0535, "half_angle": 0.224}
    d.add(cw.ConeClutch("cone", base=a, follower=b, friction=friction, force=force, **cone))
    speed = cw.Ramp(height=-29.45, duration=0.11, start=0.0488)
    d.add(cw.PrescribedSpeed("motion", shaft=d.housing, base=a, speed=speed, cutoff=0.531))
    wanted = {"of": cw.minimum("play.power"), "by": "cone.force.start", "t_end": 0.2, "t_start": 0.0297}
    found = cw.differentiable(d, **wanted, rtol=rtol, atol=rtol / 100).gradient()
    # differences of fourth order at a relative tolerance of 1e-12 give it
    scale = abs(found.values[0]) / 0.1317
    assert found.matrix[0, 0] == pytest.approx(-0.943866, abs=4e-6 * scale)
