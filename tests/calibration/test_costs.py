"""What each bound costs, with the sign that it has: upper and lower ones, equations, both at once, one name twice."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from support.engagement import ENGINE, GAIN, LINING, LOAD, SPEED, discs

FREE = {"pressure": cw.together("c1.pressure.values", factor=(0.3, 3.0))}
# at half a second both discs slide: the torque is LOAD * speed / 0.5 s
PER_SPEED = LOAD / 0.5


def least(*limits, goal=None, **how):
    goal = cw.at("c1.torque", 0.1) if goal is None else goal
    return cw.calibrate(discs(), 5.0, free=FREE, minimise=goal, subject_to=limits, **how)


def speed(lower=None, upper=None, name="v"):
    return cw.limit(cw.at("load.speed", 0.5), lower, upper, name=name)


def test_a_lower_bound_costs_what_the_goal_rises_by():
    found = least(speed(lower=10.0))
    (held,) = found.limits
    assert held.by_lower == pytest.approx(PER_SPEED, rel=1e-6)
    assert held.by_upper == 0.0
    assert held.multiplier == pytest.approx(PER_SPEED, rel=1e-6)
    assert found.costs == ("1 rad/s less asked of v saves 1.6 N m of c1.torque at",)


def test_the_front_over_a_lower_bound_has_the_slope_of_its_points():
    front = least(speed(lower=10.0)).front("v", [9.0, 10.0, 11.0])
    assert front.slopes == pytest.approx(np.gradient(front.goals, front.bounds), rel=1e-5)


@pytest.mark.parametrize("weight", [1.0, -1.0])
def test_an_equation_costs_or_saves_as_its_goal_says(weight):
    found, more = (least(speed(value, value), goal={cw.at("c1.torque", 0.1): weight}) for value in (10.0, 11.0))
    (held,) = found.limits
    assert held.by_upper == held.by_lower == pytest.approx(more.goal[1] - found.goal[1], rel=1e-5)
    (said,) = found.costs
    assert said.startswith(f"1 rad/s more asked of v {'costs' if weight > 0.0 else 'saves'} 1.6 N m")


def test_of_two_bounds_the_one_that_binds_has_the_cost():
    found = least(speed(10.0, 15.0))
    assert found.limits[0].by_upper == 0.0
    assert found.costs == ("1 rad/s less asked of v saves 1.6 N m of c1.torque at",)
    assert np.all(found.front("v", [15.0, 16.0]).slopes == 0.0)


def test_limits_of_one_name_are_apart():
    found = least(speed(lower=10.0), speed(upper=30.0))
    assert [one.active for one in found.limits] == [True, False]
    with pytest.raises(cw.UseError, match="2 limits are called 'v': give each a name="):
        found.front("v", [9.0])


def test_broken_limits_have_no_price():
    found = least(speed(lower=10.0), cw.limit(cw.at("load.speed", 0.5), upper=8.0, name="w"))
    assert not found.feasible
    assert found.costs == ()
    assert str(found).count("broken") >= 1
    assert "of its scale; residual" in str(found)


def test_a_front_beyond_what_can_be_held_has_a_gap():
    front = least(speed(lower=10.0)).front("v", [10.0, 1e3])
    assert front.goals[0] == pytest.approx(16.0, rel=1e-6)
    assert np.isnan(front.goals[1])


def profile(*pressures):
    """The same discs under a pressure with knots."""
    model = cw.Driveline("two discs")
    engine, load = model.shaft("engine", inertia=ENGINE, speed=SPEED), model.shaft("load", inertia=LOAD)
    knots = cw.Table(list(zip((0.0, 0.3, 0.6, 1.0, 5.0), pressures, strict=True)))
    lining = cw.Coulomb(static=1.2 * LINING, kinetic=LINING)
    model.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=GAIN, pressure=knots))
    return model


@pytest.mark.parametrize("band", [0.0, 0.005, 0.5])
def test_in_narrow_bands_the_goal_is_made_least_too(band):
    found = cw.calibrate(
        profile(*[1e5] * 5),
        5.0,
        free={"c1.pressure.values": (1e4, 6e5)},
        minimise=cw.jerk("load", 0.1, (0.0, 4.0)),
        subject_to=[speed(10.0, 10.0 + band), cw.limit(cw.at("load.speed", 1.0), lower=18.0)],
    )
    # the first values that hold both have 64 rad/s3 and all of the gradient is left
    assert found.solved, found.message
    assert found.goal[1] < 55.0


def test_a_goal_of_nothing_is_measured_by_that_of_the_start():
    found = cw.calibrate(
        profile(1e5, 3e5, 2e5, 4e5, 4e5),
        5.0,
        free={"c1.pressure.values": (1e4, 6e5)},
        minimise=cw.squared_slope("c1.pressure"),
        subject_to=cw.limit(cw.lock("c1"), upper=3.0),
    )
    assert found.goal[1] < 1e-9 * found.goal[0]
    assert found.solved, found.message
    assert found.certificate.residual < 1e-6
