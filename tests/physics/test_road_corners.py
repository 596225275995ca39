"""A vehicle at a corner of its road: where both slopes lead back to it, it comes to rest there and stays."""

from __future__ import annotations

import math
import random
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import seeds
from support.runs import TIGHT, at_end

G = 9.80665
MASS = 100.0
FLAT_THEN = 0.5  # m


def _car(elevation: list[tuple[float, float]], c0: float, push: Any, x: float = 0.0, v: float = 0.0) -> cw.Driveline:
    """A car of 100 kg on a road, pushed."""
    d = cw.Driveline("corner")
    car = d.mass("car", mass=MASS, speed=v)
    road = d.add(cw.Road("road", elevation=elevation, speed=car, initial_position=x))
    d.add(cw.Vehicle("v", mass=car, rolling_coefficient=c0, slope=road))
    d.add(cw.Torque("push", shaft=car, torque=push))
    return d


def _hill(rise: float) -> list[tuple[float, float]]:
    """Level for half a metre, then a hill."""
    return [(0.0, 0.0), (FLAT_THEN, 0.0), (FLAT_THEN + 100.0, 100.0 * rise)]


def _forces(rise: float, c0: float) -> tuple[float, float]:
    """What pulls downhill, and the rolling resistance, on a slope."""
    a = math.atan(rise)
    return MASS * G * math.sin(a), MASS * G * math.cos(a) * c0


def _rests_after(push: float, rise: float, c0: float) -> float:
    """Sum of all hops over the foot of the hill, each a share of the last one: it ends in a finite time."""
    weight, on_hill = _forces(rise, c0)
    level = MASS * G * c0
    onward, backward = (push - level) / MASS, (push + level) / MASS
    up, down = (weight + on_hill - push) / MASS, (weight - on_hill - push) / MASS
    v = math.sqrt(2.0 * onward * FLAT_THEN)
    returns, again = math.sqrt(down / up), math.sqrt(onward / backward)
    hop = v * (1.0 / up + returns / down + returns / backward + returns * again / onward)
    return v / onward + hop / (1.0 - returns * again)


PUSHES = [(50.0, 0.2, 0.012), (150.0, 0.2, 0.012), (100.0, 0.2, 0.03), (40.0, 0.1, 0.03), (60.0, 0.2, 0.05)]


@pytest.mark.parametrize(("push", "rise", "c0"), PUSHES)
def test_hops_over_the_foot_of_a_hill_end_there(push: float, rise: float, c0: float) -> None:
    run = _car(_hill(rise), c0, push).simulate(40.0, **TIGHT)
    assert run.status == "done"
    last = run.events[-1]
    assert (last.element, last.after, last.cause) == ("v.rolling", "locked", "slip zero")
    # what is left of the hops is below a nanometre: some milliseconds
    rests = _rests_after(push, rise, c0)
    assert rests - 5e-3 < last.time <= rests + 1e-6
    assert at_end(run, "road.position") == FLAT_THEN
    assert at_end(run, "car.speed") == 0.0
    # the slope is between both sides, and what is held balances it
    slope = at_end(run, "road.slope")
    assert 0.0 <= slope <= rise
    held = MASS * G * math.sin(math.atan(slope)) - push
    assert at_end(run, "v.rolling.torque") == pytest.approx(held, abs=1e-9)
    assert abs(held) <= MASS * G * c0
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


@pytest.mark.parametrize(("left", "right"), [(-0.2, 0.3), (-0.05, 0.02), (0.05, 0.3), (-0.3, -0.05)])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_valley_is_left_where_the_push_exceeds_its_side(left: float, right: float, way: float) -> None:
    """By weight and rolling resistance of the side that it leaves to, whatever was held on the way there."""
    c0, limit = 0.012, 500.0
    weight, rolls = _forces(right if way > 0 else left, c0)
    # from a push that both sides hold together
    start = MASS * G * math.sin(math.atan(0.5 * (left + right)))
    push = cw.Table([(0.0, start), (100.0, start + way * limit)])
    run = _car([(0.0, -50.0 * left), (50.0, 0.0), (100.0, 50.0 * right)], c0, push, x=50.0).simulate(99.0, **TIGHT)
    leaves = next(event for event in run.events if event.before == "locked")
    rate = way * limit / 100.0
    assert leaves.after == ("forward" if way > 0 else "backward")
    assert leaves.time == pytest.approx((weight + way * rolls - start) / rate, rel=1e-9)
    assert run["road.position"][run.time < leaves.time] == pytest.approx(50.0, abs=1e-12)
    # the force grows with the time from zero on: v = rate t^2/(2 m) while it is on that side
    after = (run.time > leaves.time) & (run.time < leaves.time + 2.0)
    since = run.time[after] - leaves.time
    assert run["car.speed"][after] == pytest.approx(rate * since**2 / (2.0 * MASS), rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("amplitude", [30.0, 120.0, 190.0])
def test_a_push_that_swings_within_the_valley_moves_nothing(amplitude: float) -> None:
    """One of its sides holds alone for a while, then neither, then the other one."""
    push = cw.Sine(amplitude=amplitude, frequency=1.0)
    run = _car([(0.0, 10.0), (50.0, 0.0), (100.0, 15.0)], 0.012, push, x=50.0).simulate(5.0)
    assert run.status == "done"
    assert len(run.events) == 0
    assert run["road.position"] == pytest.approx(50.0, abs=1e-12)
    held = MASS * G * np.sin(np.arctan(run["road.slope"])) - amplitude * np.sin(2.0 * math.pi * run.time)
    assert np.all(np.abs(held) <= MASS * G * 0.012 + 1e-6)


@pytest.mark.parametrize("seed", seeds(8))
def test_a_car_that_coasts_into_a_valley_rests_at_its_bottom(seed: int) -> None:
    """Whatever lies beside it: each of both slopes is steeper than what the tyres hold."""
    rng = random.Random(seed)
    left, right, c0 = -rng.uniform(0.03, 0.2), rng.uniform(0.03, 0.2), rng.uniform(0.01, 0.025)
    # flat places, so that round-off of the position is seen
    bottom = rng.choice([0.0, 1e-3, 100.0, 12345.678])
    road = [(bottom - 1e3, -1e3 * left), (bottom, 0.0), (bottom + 1e3, 1e3 * right)]
    run = _car(road, c0, 0.0, x=bottom - rng.uniform(1.0, 50.0)).simulate(400.0)
    assert run.status == "done"
    assert at_end(run, "road.position") == bottom
    assert at_end(run, "car.speed") == 0.0
    assert abs(at_end(run, "v.rolling.torque")) <= MASS * G * c0


@pytest.mark.parametrize("push", [0.0, 5.0, -5.0])
def test_a_locked_brake_holds_at_the_bottom_of_a_valley(push: float) -> None:
    """Brake and tyres hold together, then the brake opens: the valley alone holds."""
    d = cw.Driveline("braked")
    car = d.mass("car", mass=MASS)
    wheel = d.shaft("wheel", inertia=0.5)
    d.add(cw.RollingWheel("tyre", shaft=wheel, mass=car, radius=0.3))
    road = d.add(cw.Road("road", elevation=[(0.0, 5.0), (50.0, 0.0), (100.0, 5.0)], speed=car, initial_position=48.0))
    d.add(cw.Vehicle("v", mass=car, rolling_coefficient=0.012, slope=road))
    d.add(cw.Torque("push", shaft=car, torque=push))
    presses = cw.Table([(0.0, 0.0), (60.0, 0.0), (61.0, 100.0), (70.0, 100.0), (71.0, 0.0)])
    dry = cw.Coulomb(static=0.3, kinetic=0.25)
    d.add(cw.Brake("brake", shaft=wheel, friction=dry, gain=0.1, normal_force=presses))
    run = d.simulate(80.0)
    assert run.status == "done"
    assert at_end(run, "road.position") == pytest.approx(50.0, abs=1e-12)
    assert at_end(run, "car.speed") == 0.0


@pytest.mark.parametrize("rise", [0.1, -0.1])
@pytest.mark.parametrize("push", [-300.0, 300.0, 0.0, -20.0])
def test_a_car_that_starts_at_a_corner_is_on_the_side_to_which_it_goes(push: float, rise: float) -> None:
    """The road is level before its first point, at which it starts."""
    c0 = 0.012
    run = _car([(0.0, 0.0), (100.0, 100.0 * rise)], c0, push).simulate(1.0, **TIGHT)
    weight, rolls = _forces(rise, c0)
    ahead, back = push - weight - rolls, push + MASS * G * c0
    wanted = max(ahead, 0.0) if ahead > 0.0 else min(back, 0.0)
    assert at_end(run, "car.speed") == pytest.approx(wanted / MASS, abs=1e-9)


def test_a_slope_between_both_sides_has_no_derivative() -> None:
    d = _car([(0.0, 10.0), (50.0, 0.0), (100.0, 20.0)], 0.012, 50.0, x=50.0)
    found = cw.differentiable(d, 1.0, of=["road.slope", "car.speed"], by="push.torque").gradient()
    assert np.isnan(found.matrix[0, 0])
    assert found.matrix[1, 0] == 0.0
    assert "ends at a corner at rest" in found.problems[0]


def test_a_freewheel_that_only_a_trial_would_overload_stays_sound() -> None:
    """At the foot of a hill of 0.55 a car is held by its freewheel: the whole slope would break that."""
    d = _car([(0.0, 0.0), (50.0, 0.0), (100.0, 27.5)], 0.012, cw.Step(height=100.0, start=1.0), x=50.0)
    d.add(cw.SpragClutch("f", base=d.housing, follower=d.nodes[0], holding=300.0))
    run = d.simulate(2.0)
    assert run.status == "done"
    assert not [event for event in run.events if event.cause == "fault"]
    assert np.abs(run["car.speed"]).max() < 1e-9


def test_a_road_of_other_heights_is_not_taken_for_its_corner() -> None:
    """Its slopes are those of the point that is looked at."""
    d = _car([(0.0, 0.0), (50.0, 5.0), (100.0, 20.0)], 0.012, 500.0, x=10.0)
    f = cw.differentiable(d, 1.0, of=["v.rolling.torque", "road.slope"], by="road.elevation.values[2]")
    found = f.gradient(f.x0 + 1.0)
    assert found.problems == ()
    np.testing.assert_allclose(found.matrix[1], 1.0 / 50.0, rtol=1e-9)
