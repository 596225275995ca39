"""A vehicle on a road: coast-down, standstill on a grade, wind, elevation over position."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from support.amount import seeds
from support.runs import EXACT, TIGHT, at_end

G = 9.80665
MASS = 1500.0


def _car(speed: float = 0.0, **more: Any) -> cw.Driveline:
    """A car of 1500 kg with its resistances."""
    d = cw.Driveline("car")
    d.add(cw.Vehicle("v", mass=d.mass("car", mass=MASS, speed=speed), **more))
    return d


def _balanced(run: Any) -> None:
    # 1e-8: asked for, at rtol 1e-9 or finer
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_coast_down_is_that_of_the_closed_form() -> None:
    """m dv/dt = -k v^2 - R: v = sqrt(R/k) tan(...), at rest after m/sqrt(R k) atan(v0 sqrt(k/R)), and for ever."""
    slope, area, coefficient, v0 = 0.01, 0.7, 0.012, 30.0
    run = _car(v0, drag_area=area, rolling_coefficient=coefficient, slope=slope).simulate(4000.0, **TIGHT)
    a, k = math.atan(slope), 0.5 * 1.2 * area
    resistance = MASS * G * (math.sin(a) + coefficient * math.cos(a))
    stop = MASS / math.sqrt(resistance * k) * math.atan(v0 * math.sqrt(k / resistance))
    (event,) = run.events
    assert (event.element, event.after, event.cause) == ("v.rolling", "locked", "slip zero")
    assert event.time == pytest.approx(stop, abs=EXACT)
    way = MASS / (2 * k) * math.log1p(k * v0**2 / resistance)
    # the way is integrated to 1e-12
    assert at_end(run, "car.position") == pytest.approx(way, rel=1e-10)
    assert at_end(run, "v.grade.height") == pytest.approx(way * math.sin(a), rel=1e-10)
    # the multiplier balances the grade
    assert at_end(run, "v.rolling.torque") == pytest.approx(MASS * G * math.sin(a), rel=1e-12)
    assert np.all(run["car.speed"][run.time > stop + 1e-9] == 0.0)
    _balanced(run)


def test_a_rolling_coefficient_that_rises_with_the_speed() -> None:
    """dv/dt = -g (c0 + c1 v): at rest after log(1 + c1 v0/c0)/(g c1)."""
    c0, c1, v0 = 0.012, 4e-4, 25.0
    run = _car(v0, rolling_coefficient=c0, rolling_rise=c1).simulate(400.0, **TIGHT)
    assert run.events[0].time == pytest.approx(math.log1p(c1 * v0 / c0) / (G * c1), abs=EXACT)
    _balanced(run)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_car_breaks_away_where_the_slope_passes_the_coefficient(sign: float) -> None:
    """The slope rises by 0.001 per second: 0.012 is passed at 12 s, and held below it."""
    slope = cw.Ramp(height=sign * 0.02, duration=20.0)
    run = _car(rolling_coefficient=0.012, slope=slope).simulate(20.0, **TIGHT)
    (event,) = [e for e in run.events if e.before == "locked"]
    assert event.time == pytest.approx(12.0, abs=EXACT)
    assert event.after == ("backward" if sign > 0 else "forward")
    assert np.all(run["car.speed"][run.time < 12.0] == 0.0)
    _balanced(run)


@pytest.mark.parametrize(("slope", "moves"), [(0.012 * (1 - 1e-9), False), (0.012 * (1 + 1e-9), True)])
def test_a_grade_below_the_coefficient_holds_for_ever(slope: float, moves: bool) -> None:
    run = _car(rolling_coefficient=0.012, slope=slope).simulate(1e5, rtol=1e-9)
    assert (abs(at_end(run, "car.speed")) > 0.0) == moves


@pytest.mark.parametrize(("speed", "wind"), [(20.0, 0.0), (-20.0, 0.0), (5.0, 12.0), (-5.0, -12.0)])
def test_air_from_either_side_drags_from_the_first_row_on(speed: float, wind: float) -> None:
    """Force and linear system of the start itself: -rho A u abs(u)/2 and its slope."""
    d = cw.Driveline("air")
    car = d.mass("car", mass=1000.0, speed=speed)
    d.add(cw.AirDrag("air", shaft=car, area=0.7, density=1.2, wind=wind))
    through = speed - wind
    assert d.simulate(1e-3)["air.torque"][0] == pytest.approx(-0.42 * through * abs(through), rel=1e-12)
    assert cw.linearise(d).A[0, 0] == pytest.approx(-0.84 * abs(through) / 1000.0, rel=1e-12)


def test_wind_against_an_independent_solution() -> None:
    """A gust that turns the sign of the speed through the air; SciPy at rtol 1e-12."""
    area, coefficient = 2.5, 0.002
    wind = cw.Sine(amplitude=30.0, frequency=0.05, offset=5.0)
    run = _car(12.0, drag_area=area, rolling_coefficient=coefficient, wind=wind).simulate(40.0, dt=0.5, **TIGHT)

    def slope(t: float, v: Any) -> list[float]:
        u = v[0] - 5.0 - 30.0 * math.sin(2 * math.pi * 0.05 * t)
        return [-0.6 * area / MASS * u * abs(u) - coefficient * G]

    made = solve_ivp(slope, (0.0, 40.0), [12.0], method="DOP853", rtol=1e-12, atol=1e-12, t_eval=run.time)
    assert np.min(made.y[0]) > 0.0
    # 1e-9 of the speed; SciPy runs over the kink of the drag
    assert np.allclose(run["car.speed"], made.y[0], rtol=0.0, atol=1e-8)
    assert np.min(run["car.speed"] - run["v.drag.wind"]) < 0.0
    _balanced(run)


def _reference(points: list[tuple[float, float]], c0: float, x: float, v: float, t_end: float) -> tuple[float, float]:
    """Horizontal place and speed at the end without drag: uniform acceleration between the points, from the left."""
    t = 0.0
    for _ in range(1000):
        bounds = [-math.inf, *(p for p, _ in points), math.inf]
        # at a point the piece that the motion goes to
        k = max(i for i in range(len(bounds) - 1) if bounds[i] < x or (bounds[i] == x and v >= 0))
        inside = 0 < k < len(points)
        grade = (points[k][1] - points[k - 1][1]) / (points[k][0] - points[k - 1][0]) if inside else 0.0
        sine, cosine = grade / math.hypot(1, grade), 1 / math.hypot(1, grade)
        if v == 0.0 and abs(grade) <= c0:
            return x, 0.0
        way = math.copysign(1.0, v if v else -grade)
        acceleration = -G * sine - way * G * c0 * cosine
        ends = [t_end - t]
        if v * acceleration < 0:
            ends.append(-v / acceleration)
        target = bounds[k + 1] if way > 0 else bounds[k]
        room = (target - x) / cosine
        square = v * v + 2 * acceleration * room
        if math.isfinite(room) and square >= 0:
            to = 2 * room / (v + way * math.sqrt(square))
            ends.append(to)
        step = min(ends)
        t += step
        if step == ends[0] and t >= t_end - 1e-12:
            return x + cosine * (v * step + 0.5 * acceleration * step**2), v + acceleration * step
        if step == ends[-1] and math.isfinite(room) and square >= 0:
            x, v = target, v + acceleration * step
        else:
            x, v = x + cosine * (v * step + 0.5 * acceleration * step**2), 0.0
    raise AssertionError


@pytest.mark.parametrize("seed", seeds(30))
def test_random_roads_against_uniform_acceleration(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 9))
    places = np.cumsum(rng.uniform(5.0, 60.0, n))
    heights = np.cumsum(rng.uniform(-2.0, 2.0, n))
    points = [(float(x), float(z)) for x, z in zip(places, heights, strict=True)]
    c0, v, x, t_end = (
        float(rng.uniform(0.005, 0.03)),
        float(rng.uniform(2.0, 20.0)),
        float(rng.uniform(0.0, 30.0)),
        12.0,
    )
    d = cw.Driveline("hills")
    car = d.mass("car", mass=MASS, speed=v, position=100.0)
    road = d.add(cw.Road("road", elevation=points, speed=car, initial_position=x))
    d.add(cw.Vehicle("v", mass=car, rolling_coefficient=c0, slope=road))
    run = d.simulate(t_end, **TIGHT)
    place, speed = _reference(points, c0, x, v, t_end)
    # 1e-8: the tolerance adds up over some ten events
    assert at_end(run, "car.speed") == pytest.approx(speed, abs=1e-8)
    assert at_end(run, "road.position") == pytest.approx(place, abs=1e-8)
    height = np.interp([x, place], places, heights)
    assert at_end(run, "v.grade.height") == pytest.approx(height[1] - height[0], abs=1e-8)
    _balanced(run)


def test_a_car_in_the_middle_of_a_road_of_many_points_starts_there() -> None:
    d = cw.Driveline("long road")
    places = np.arange(0.0, 5000.0, 10.0)
    points = [(float(x), float(5 * math.sin(x / 300))) for x in places]
    car = d.mass("car", mass=MASS)
    road = d.add(cw.Road("road", elevation=points, speed=car, initial_position=4000.5))
    d.add(cw.Vehicle("v", mass=car, rolling_coefficient=0.0, slope=road))
    run = d.simulate(1e-3)
    assert run["road.slope"][0] == pytest.approx((points[401][1] - points[400][1]) / 10.0, rel=1e-12)


def test_a_run_over_a_road_goes_on_from_a_saved_state(tmp_path: Any) -> None:
    d = cw.Driveline("saved")
    car = d.mass("car", mass=MASS, speed=20.0)
    road = d.add(cw.Road("road", elevation=[(0.0, 0.0), (40.0, 2.0), (90.0, 1.0), (150.0, 6.0)], speed=car))
    d.add(cw.Vehicle("v", mass=car, drag_area=0.7, slope=road))
    whole = cw.Simulator(d)
    whole.advance(3.0)
    whole.save().save(tmp_path / "car.state")
    whole.advance(8.0)
    again = cw.Simulator(d)
    again.restore(cw.State.load(tmp_path / "car.state"))
    again.advance(8.0)
    assert again["car.speed"] == whole["car.speed"]
    assert again["road.position"] == whole["road.position"]


def test_a_vehicle_without_mass_is_refused() -> None:
    d = cw.Driveline("light")
    d.add(cw.Vehicle("v", mass=d.mass("car")))
    with pytest.raises(cw.ModelError, match="has no mass, so no weight"):
        d.simulate(1.0)
