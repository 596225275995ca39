"""What sets off without an acceleration, and loads that end between two steps."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw

BRISTLES = {
    "lugre": cw.LuGre(static=0.634, kinetic=0.4676, speed=2.552, stiffness=929.6, damping=0.005754, viscous=0.0021),
    "dahl": cw.Dahl(kinetic=0.5, stiffness=800.0),
    "elastoplastic": cw.ElastoPlastic(
        static=0.6, kinetic=0.45, speed=2.5, stiffness=900.0, damping=0.005, viscous=0.0017, elastic=0.0003
    ),
}


@pytest.mark.parametrize("frequency", [3.3, 6.5477, 8.9])
@pytest.mark.parametrize("law", BRISTLES)
def test_pressure_touches_zero_beside_bristles(law: str, frequency: float) -> None:
    """What the bristles hold is as large as what the other clutch lets go: its slip starts with a jerk alone."""
    d = cw.Driveline("touch")
    s1, s2 = d.shaft("s1", inertia=0.054), d.shaft("s2", inertia=0.0033, speed=80.0)
    wave = cw.Sine(amplitude=1e6, frequency=frequency, offset=1e6)
    dry = cw.Coulomb(static=0.4, kinetic=0.4)
    d.add(cw.Clutch("e1", base=s1, follower=s2, friction=dry, gain=1e-6, pressure=wave))
    d.add(cw.Clutch("e2", base=s1, follower=s2, friction=BRISTLES[law], gain=1e-3, pressure=8.6e4))
    run = d.simulate(1.0)
    assert run.status == "done"
    momentum = 0.054 * run["s1.speed"] + 0.0033 * run["s2.speed"]
    assert momentum == pytest.approx(80.0 * 0.0033, rel=1e-6)


@pytest.mark.parametrize("frequency", [17.114, 17.122, 17.366])
def test_a_falling_pressure_lets_go_once(frequency: float) -> None:
    """An engine without throttle, whose clutch is let go by its pressure as slowly as that falls."""
    d = cw.Driveline("car")
    s0, s1 = d.shaft("s0", inertia=0.3486, speed=181.9), d.shaft("s1", inertia=0.04308)
    s2, s3, m4 = d.shaft("s2", inertia=0.1956), d.shaft("s3", inertia=2.582), d.mass("m4", mass=1436.0)
    full_load = [(0.0, 227.9), (150.0, 379.8), (400.0, 341.9), (650.0, 0.0)]
    motoring = [(0.0, -26.59), (600.0, -75.97)]
    d.add(cw.Engine("e1", shaft=s0, throttle=0.0, full_load=full_load, motoring=motoring))
    law = cw.Stribeck(static=0.3464, kinetic=0.2461, speed=0.03504, shape="tustin", viscous=0.008421)
    wave = cw.Sine(amplitude=17370.0, frequency=frequency, offset=10420.0)
    d.add(cw.DiskClutch("e2", base=s0, follower=s1, friction=law, radius=0.12, area=0.1615, pressure=wave))
    ratio = cw.Ramp(height=-0.01511, duration=1.321, offset=2.229)
    d.add(cw.VariableRatio("e3", input=s1, output=s2, ratio=ratio, capacity=421.4))
    d.add(cw.Gear("e4", input=s2, output=s3, ratio=2.723))
    d.add(cw.RollingWheel("e5", shaft=s3, mass=m4, radius=0.3))
    run, tight = d.simulate(0.5), d.simulate(0.5, rtol=1e-8)
    assert (run.status, tight.status) == ("done", "done")
    found, known = ([(one.element, one.after) for one in both.events] for both in (run, tight))
    assert found == known


def test_a_set_gives_way_before_a_load_ends_inside_a_step() -> None:
    """At the end of the step another load has ended too, so that nothing is left to hold there."""
    d = cw.Driveline("belts")
    s0, s1 = d.shaft("s0"), d.shaft("s1", inertia=1.0)
    falls = cw.Ramp(height=-2065.0, duration=0.019998, start=0.03999, offset=1185.0)
    d.add(cw.BeltContact("e1", base=s0, follower=s1, forward=1.0, backward=1.0, tension=falls))
    dry = cw.Coulomb(static=0.035, kinetic=0.03)
    d.add(cw.DiskClutch("e4", base=s1, follower=s0, friction=dry, radius=0.08, normal_force=10.0))
    tension = cw.Table([(0.006476, 362.7), (0.07652, -181.7)])
    belt = {"radius_base": 0.1, "radius_follower": 0.03, "centre_distance": 1.0, "friction_coefficient": 0.07}
    d.add(cw.BeltDrive("e5", base=s1, follower=s0, preload=tension, **belt))
    turn = cw.Table([(0.0007636, 0.03), (0.05389, 0.02723)])
    d.add(cw.PrescribedPosition("motion", shaft=s0, position=turn))
    run = d.simulate(0.0535)
    # what the belt asks for is held by both until the tension is what the clutch leaves of it
    let_go = next(one for one in run.events if one.cause == "torque limit" and one.element == "e1")
    before = run.at([let_go.time * (1.0 - 1e-12)])
    asked = 0.1 * abs(before["e5.torque"][0])
    assert abs(before["e4.torque"][0]) == pytest.approx(before["e4.capacity"][0], rel=1e-6)
    assert abs(let_go.torque_before) == pytest.approx(asked - before["e4.capacity"][0], rel=1e-5)
    held = run["e1.state"] == "locked"
    assert np.all(np.abs(run["e1.torque"][held]) <= run["e1.capacity"][held] * (1.0 + 1e-6) + 1e-9)


def test_a_slip_that_swings_within_a_step() -> None:
    """A bearing that is let go beside a stiff synchroniser: its rows slip as their mode says."""
    d = cw.Driveline("synchroniser")
    s0, s1 = d.shaft("s0", inertia=1.0, speed=-6.46), d.shaft("s1", inertia=0.0041, speed=-4.13)
    s2 = d.shaft("s2")
    d.add(cw.PrescribedAcceleration("e1", shaft=s2, acceleration=1.0))
    d.add(cw.ValveBody("e0", shaft=s1, piston_areas={"A": 0.00581}))
    cone = cw.Dahl(kinetic=0.102, stiffness=3130.0)
    half = {"force": 900.0, "radius": 1.0, "half_angle": 1.0, "command": 1.0}
    d.add(cw.Synchroniser("e2", hub=s0, forward=s1, friction=cone, **half))
    rests = cw.Coulomb(static=0.1172, kinetic=0.0855)
    d.add(cw.BearingFriction("e6", shaft=s1, base=s0, friction=rests, torque=1.0))
    run = d.simulate(0.0761)
    slip, mode = run["e6.slip"], run["e6.mode"]
    fastest = np.abs(run["s0.speed"]).max()
    assert np.all(slip * mode >= -1e-6 * fastest)


TOUCHES_ZERO = cw.Sine(amplitude=200.0, frequency=10.0, offset=200.0)
DRY = cw.Coulomb(static=0.2, kinetic=0.2)


def let_go(run: cw.Result, element: str) -> list[float]:
    return [one.time for one in run.events if one.element == element and one.before == "locked"]


@pytest.mark.parametrize("beside", ["lossy gear", "second brake", "disc at its limit"])
@pytest.mark.parametrize("torque", [1e-3, 0.005, 0.02])
def test_a_brake_whose_force_touches_zero_lets_go(beside: str, torque: float) -> None:
    """For a moment it holds less than a torque of which it holds thousands of times as much before and after."""
    d = cw.Driveline("touch")
    shaft, other = d.shaft("shaft", inertia=1.0), d.shaft("other", inertia=1.0)
    d.add(cw.Torque("load", shaft=shaft, torque=torque))
    d.add(cw.Brake("brake", shaft=shaft, friction=DRY, gain=1.0, normal_force=TOUCHES_ZERO))
    if beside == "lossy gear":
        d.add(cw.LossyGear("gear", input=shaft, output=other, ratio=4.0, efficiency=0.6))
    elif beside == "second brake":
        d.add(cw.Brake("second", shaft=shaft, friction=DRY, gain=0.5, normal_force=TOUCHES_ZERO))
    else:
        # what it has left is less than what can change in a step all the time
        d.add(cw.Torque("swings", shaft=other, torque=cw.Sine(amplitude=1e-4, frequency=10.0 / 3.0, phase=1.0)))
        d.add(cw.Brake("second", shaft=other, friction=DRY, gain=1.0, normal_force=5.001e-4))
    run = d.simulate(0.5)
    # its capacity is 40 (1 + sin w t), and all that hold the shaft touch zero together
    held = 60.0 if beside == "second brake" else 40.0
    before = np.arccos(1.0 - torque / held) / (20.0 * np.pi)
    assert let_go(run, "brake") == pytest.approx([0.075 + 0.1 * k - before for k in range(5)], abs=1e-7)


@pytest.mark.parametrize("kind", ["belt drive", "belt", "clutch"])
@pytest.mark.parametrize("phase", [0.5 * np.pi, 1.5 * np.pi])
@pytest.mark.parametrize("torque", [0.0, 1.0])
def test_what_touches_zero_at_a_knot_stays_pressed(kind: str, phase: float, torque: float) -> None:
    """Its slope is round-off there, of either sign; at the start of a run too."""
    touch = 0.5 if phase < np.pi else 0.0
    d = cw.Driveline("touch")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    wave = cw.Sine(amplitude=200.0, frequency=1.0, offset=200.0, phase=phase)
    if kind == "belt drive":
        belt = {"radius_base": 0.1, "radius_follower": 0.05, "centre_distance": 0.5, "friction_coefficient": 0.3}
        d.add(cw.BeltDrive("grip", base=a, follower=b, preload=wave, **belt))
    elif kind == "belt":
        d.add(cw.BeltContact("grip", base=a, follower=b, forward=1.5, backward=0.8, tension=wave))
    else:
        d.add(cw.Clutch("grip", base=a, follower=b, friction=DRY, gain=0.1, normal_force=wave))
    falls = cw.Step(height=-10.0, start=0.5, offset=10.0)
    d.add(cw.Brake("brake", shaft=b, friction=DRY, gain=1.0, normal_force=falls))
    if torque > 0:
        d.add(cw.Torque("load", shaft=a, torque=torque))
    run = d.simulate(0.9)
    assert run.status == "done"
    if torque == 0:
        assert np.all(run["grip.state"] == "locked")
        assert [one.element for one in run.events] == ["brake"]
        return
    slips = (np.abs(run["grip.slip"]) > 1e-6) & (np.abs(run.time - touch) > 1e-3)
    assert np.all(np.abs(run["grip.torque"][slips]) == pytest.approx(run["grip.capacity"][slips], rel=1e-6))
    assert run["grip.state"][-1] == "locked"
