"""Belts: the limit of Eytelwein, centrifugal force, crossed, grooved, tensioners; contacts that read a speed."""

from __future__ import annotations

from math import asin, exp, pi, sin, sqrt, tanh

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw

R1, R2, DISTANCE, MU = 0.06, 0.11, 0.4, 0.3
WRAP = pi - 2 * asin((R2 - R1) / DISTANCE)


def _drive(torque, held=None, **values):
    """A belt that is pulled on its base, and held or free on its follower."""
    d = cw.Driveline("belt")
    a, b = d.shaft("a", inertia=0.02), d.shaft("b", inertia=0.1)
    given = {"radius_base": R1, "radius_follower": R2, "centre_distance": DISTANCE, "friction_coefficient": MU}
    grip = {} if "tensioner" in values else {"preload": 250.0}
    belt = d.add(cw.BeltDrive("belt", base=a, follower=b, **given | grip | values))
    d.add(cw.Torque("t", shaft=a, torque=torque))
    if held is not None:
        d.add(cw.PrescribedSpeed("held", shaft=b, speed=held))
    return d, belt


@pytest.mark.parametrize(
    ("values", "factors"),
    [
        ({}, (2 * tanh(MU * WRAP / 2),) * 2),
        ({"groove_angle": 0.7}, (2 * tanh(MU / sin(0.35) * WRAP / 2),) * 2),
        ({"crossed": True}, (2 * tanh(MU * (pi + 2 * asin((R1 + R2) / DISTANCE)) / 2),) * 2),
        ({"tensioner": 250.0}, (exp(MU * WRAP) - 1, 1 - exp(-MU * WRAP))),
        ({"tensioner": 250.0, "tensioned": "tight"}, (1 - exp(-MU * WRAP), exp(MU * WRAP) - 1)),
    ],
)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_it_slips_at_the_limit_of_eytelwein(values, factors, sign):
    # the follower stands, the base is pulled ever harder: the rim force is torque over radius
    d, belt = _drive(cw.Ramp(height=sign * 60.0, duration=1.0), held=0.0, **values)
    run = d.simulate(1.0, dt=0.1)
    (event,) = [event for event in run.events if event.time > 0]
    crossing = -1.0 if values.get("crossed") else 1.0
    limit = 250.0 * (factors[0] if sign * crossing > 0 else factors[1])
    assert event.time == pytest.approx(limit * R1 / 60.0, rel=1e-9)
    assert run["belt.torque"][-1] == pytest.approx(sign * crossing * limit)
    # tight over slack strand
    mu = MU / sin(values.get("groove_angle", pi) / 2)
    if "tensioner" in values:
        fixed, other = 250.0, 250.0 + limit
        if (sign * crossing > 0) == (values.get("tensioned") == "tight"):
            other, fixed = 250.0, 250.0 - limit
    else:
        other, fixed = 250.0 + limit / 2, 250.0 - limit / 2
    assert other / fixed == pytest.approx(exp(mu * belt.wrap))


@pytest.mark.parametrize("crossed", [False, True])
def test_without_slip_it_is_a_gear(crossed):
    d, _ = _drive(5.0, crossed=crossed, mass_per_length=0.1, locked=True)
    other = cw.Driveline("gear")
    a, b = other.shaft("a", inertia=0.02), other.shaft("b", inertia=0.1)
    other.add(cw.Gear("g", input=a, output=b, ratio=(-1 if crossed else 1) * R2 / R1))
    other.add(cw.Torque("t", shaft=a, torque=5.0))
    run, same = d.simulate(0.5), other.simulate(0.5)
    assert run["b.speed"][-1] == pytest.approx(same["b.speed"][-1], rel=1e-9)
    assert run["belt.slip"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("radii", [(R1, R2), (R2, R1)])
def test_centrifugal_force_on_the_pulley_with_the_larger_wrap(radii):
    """A constant load, and a belt that gets faster: it lets go where its capacity has fallen to the load."""
    m, force = 0.4, 90.0
    d = cw.Driveline("belt")
    a, b = d.shaft("a", inertia=0.05), d.shaft("b", inertia=0.02)
    belt = cw.BeltDrive(
        "belt", base=a, follower=b, radius_base=radii[0], radius_follower=radii[1], centre_distance=DISTANCE,
        friction_coefficient=MU, preload=250.0, mass_per_length=m, locked=True,
    )  # fmt: skip
    d.add(belt)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=cw.Ramp(height=400.0, duration=4.0)))
    inertia_force = 0.02 / radii[1] * (100.0 * radii[0] / radii[1])
    d.add(cw.Torque("load", shaft=b, torque=-force * radii[1]))
    run = d.simulate(4.0, rtol=1e-10)
    event = next(event for event in run.events if event.cause == "torque limit")
    limit = (force + inertia_force) / (2 * tanh(MU * WRAP / 2))
    speed = sqrt((250.0 - limit) / m)
    assert event.time == pytest.approx(speed / radii[0] / 100.0, rel=1e-9)
    # the rest of the way against SciPy: the speed of the larger pulley counts
    scale = 2 * tanh(MU * WRAP / 2)

    def slope(time, w):
        v = (w[0] * radii[1]) if radii[1] > radii[0] else 100.0 * time * radii[0]
        return [(max(250.0 - m * v * v, 0.0) * scale * radii[1] - force * radii[1]) / 0.02]

    start = [event.time * 100.0 * radii[0] / radii[1]]
    other = solve_ivp(slope, (event.time, 4.0), start, rtol=1e-11, atol=1e-11, method="DOP853", max_step=0.01)
    assert run["b.speed"][-1] == pytest.approx(other.y[0, -1], rel=1e-7, abs=1e-6)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_it_lifts_off_and_comes_back():
    m = 0.5
    d, belt = _drive(0.0, mass_per_length=m)
    b = d.nodes[1]
    d.add(cw.Torque("spin", shaft=b, torque=cw.Table([(0.0, 60.0), (1.0, 60.0), (1.001, -60.0), (3.0, -60.0)])))
    d.add(cw.Damper("drag", base=d.housing, follower=d.nodes[0], damping=0.01))
    run = d.simulate(2.5, rtol=1e-10)
    v = R2 * run["b.speed"]
    left = np.maximum(250.0 - m * v * v, 0.0)
    assert np.sum(left == 0.0) > 10
    assert run["belt.capacity"] == pytest.approx(left * belt.limits[0], abs=1e-6)
    assert run["belt.torque"][left == 0.0] == pytest.approx(0.0, abs=1e-9)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    assert "centrifugal force" in str(run.hints)


def test_a_jump_of_the_speeds_changes_what_it_holds():
    # an impulse brings the belt to a speed at which it has no grip
    d, belt = _drive(0.0, mass_per_length=0.5)
    a, b = d.nodes
    fast = d.shaft("fast", inertia=1.0, speed=400.0)
    d.add(cw.PrescribedSpeed("p", shaft=b, speed=cw.Step(height=300.0, start=0.1)))
    d.add(cw.Damper("drag", base=a, follower=fast, damping=0.01))
    run = d.simulate(0.2, dt=0.01)
    v = R2 * run["b.speed"]
    assert run["belt.capacity"][-1] == 0.0
    assert run["belt.capacity"] == pytest.approx(np.maximum(250.0 - 0.5 * v * v, 0.0) * belt.limits[0])


def test_linear_systems_know_what_the_speed_does_to_the_force():
    d, belt = _drive(30.0, mass_per_length=0.4)
    d.add(cw.Damper("drag", base=d.housing, follower=d.nodes[1], damping=0.05))
    run = d.simulate(1.0)
    assert run["belt.state"][-1] == "backward"
    lin = cw.linearise(run, at=1.0)
    w = run["b.speed"][-1]
    by_speed = -2 * 0.4 * w * R2 * R2 * belt.limits[0]
    names = list(lin.states)
    a, b = names.index("a.speed"), names.index("b.speed")
    assert lin.A[b, b] == pytest.approx((R2 * by_speed - 0.05) / 0.1, rel=1e-6)
    assert lin.A[a, b] == pytest.approx(-R1 * by_speed / 0.02, rel=1e-6)


def test_any_contact_and_torque_may_read_a_speed():
    """A clutch whose press follows the speed of a shaft, as a belt would be pressed by a governor."""
    d = cw.Driveline("governed")
    a, b = d.shaft("a", inertia=1.0, speed=50.0), d.shaft("b", inertia=2.0)
    contact = cw.BeltContact(
        "c",
        base=d.mass("m1", mass=1.0),
        follower=d.mass("m2", mass=1.0),
        forward=1.0,
        backward=1.0,
        tension=5.0,
        speed=a,
    )
    d.add(contact)
    assert "speed must be in [m/s], but 'a' gives [rad/s]" in str(d.check()[0])
    d = cw.Driveline("governed")
    a, b = d.mass("a", mass=1.0, speed=5.0), d.mass("b", mass=2.0)
    d.add(
        cw.BeltContact("c", base=a, follower=b, forward=0.5, backward=0.5, mass_per_length=2.0, tension=80.0, speed=a)
    )
    run = d.simulate(1.0, rtol=1e-10)
    slope = solve_ivp(lambda _, w: [-0.5 * (80.0 - 2 * w[0] ** 2)], (0.0, 0.05), [5.0], rtol=1e-11, atol=1e-12)
    assert np.interp(0.05, run.time, run["a.speed"]) == pytest.approx(slope.y[0, -1], rel=1e-3)
    assert run["a.speed"][-1] == pytest.approx(5.0 / 3.0)


def test_the_housing_may_hold_a_pulley():
    d = cw.Driveline("belt brake")
    a = d.shaft("a", inertia=0.1, speed=20.0)
    d.add(
        cw.BeltDrive(
            "belt",
            base=d.housing,
            follower=a,
            radius_base=R1,
            radius_follower=R2,
            centre_distance=DISTANCE,
            friction_coefficient=MU,
            preload=100.0,
        )
    )
    run = d.simulate(1.0)
    (event,) = run.events
    force = 100.0 * 2 * tanh(MU * WRAP / 2)
    assert event.time == pytest.approx(20.0 * 0.1 / (force * R2))


def test_axes_too_close():
    d, _ = _drive(0.0, centre_distance=0.15)
    assert "centre_distance is 0.15 m, not above both radii together, 0.17 m" in str(d.check()[0])


@pytest.mark.parametrize(("values", "quantity"), [({"groove_angle": 0.01}, "groove_angle"), ({}, "friction_coeff")])
def test_grip_of_any_force_is_refused(values, quantity):
    """The ratio of the tensions would be as e^100 and more: no belt, and no number of use."""
    friction = 0.3 if values else 40.0
    with pytest.raises(cw.ModelError, match=quantity):
        _drive(5.0, tensioner=250.0, friction_coefficient=friction, **values)[0].simulate(0.01)
    # without a tensioner the preload bounds the force
    _drive(5.0, friction_coefficient=friction, **values)[0].simulate(0.01)
