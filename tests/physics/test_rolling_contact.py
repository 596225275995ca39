"""Wheels that roll up to their grip: break-away, sliding, rolling again, brake and road and wheel at rest."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import seeds
from support.runs import EXACT, TIGHT, at_end

G, MASS, INERTIA, RADIUS = 9.80665, 1200.0, 3.0, 0.3
GRIP = cw.Coulomb(static=0.9, kinetic=0.7)
LOAD = MASS * G


def _car(*, speed: float = 0.0, wheel: float | None = None, load: Any = LOAD) -> tuple[cw.Driveline, cw.Node, cw.Node]:
    d = cw.Driveline("car")
    axle = d.shaft("axle", inertia=INERTIA, speed=speed / RADIUS if wheel is None else wheel)
    car = d.mass("car", mass=MASS, speed=speed)
    d.add(cw.RollingContact("tyre", shaft=axle, mass=car, radius=RADIUS, friction=GRIP, load=load))
    return d, axle, car


def _balanced(run: Any) -> None:
    # 1e-8: asked for, at rtol 1e-9 or finer
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_a_wheel_spins_where_its_torque_passes_the_grip() -> None:
    """Rolling, the road takes T R m/(J + m R^2); it lets go at mu N."""
    d, axle, _ = _car()
    d.add(cw.Torque("drive", shaft=axle, torque=cw.Ramp(height=8000.0, duration=4.0)))
    run = d.simulate(4.0, **TIGHT)
    whole = INERTIA + MASS * RADIUS**2
    limit = 0.9 * LOAD * whole / (MASS * RADIUS)
    (event,) = [e for e in run.events if e.before == "locked"]
    assert event.time == pytest.approx(limit / 2000.0, abs=EXACT)
    assert event.torque_after == pytest.approx(0.7 * LOAD, rel=1e-12)
    before = run.time < event.time
    assert np.allclose(run["car.speed"][before], RADIUS * run["axle.speed"][before], rtol=0.0, atol=1e-12)
    assert at_end(run, "tyre.torque") == pytest.approx(0.7 * LOAD, rel=1e-12)
    _balanced(run)


def test_a_spinning_wheel_rolls_after_the_closed_form() -> None:
    """w R falls by mu N R^2/J, v rises by mu N/m: they meet at w0 R/(mu N (R^2/J + 1/m))."""
    d, _, _ = _car(wheel=80.0)
    run = d.simulate(3.0, **TIGHT)
    force = 0.7 * LOAD
    meet = 80.0 * RADIUS / (force * (RADIUS**2 / INERTIA + 1 / MASS))
    (event,) = run.events
    assert (event.after, event.cause) == ("locked", "slip zero")
    assert event.time == pytest.approx(meet, abs=EXACT)
    assert at_end(run, "car.speed") == pytest.approx(force / MASS * meet, rel=1e-11)
    _balanced(run)


@pytest.mark.parametrize(("capacity", "moves"), [(1000.0, "brake"), (5000.0, "tyre")])
def test_brake_wheel_and_road_hold_together(capacity: float, moves: str) -> None:
    """On a slope that rises the car starts where m g sin(a) passes the least of brake/R and grip, and the road."""
    d, axle, car = _car()
    slope = cw.Ramp(height=3.0, duration=60.0)
    d.add(cw.Brake("brake", shaft=axle, friction=cw.Coulomb(static=1.0, kinetic=1.0), gain=1.0, normal_force=capacity))
    d.add(cw.Vehicle("v", mass=car, rolling_coefficient=0.012, slope=slope))
    run = d.simulate(50.0, **TIGHT)
    held = min(capacity / RADIUS, 0.9 * LOAD) / (MASS * G)
    # sin(a) = held + 0.012 cos(a)
    angle = math.asin(held / math.hypot(1.0, 0.012)) + math.atan(0.012)
    first = min(e.time for e in run.events if e.before == "locked")
    assert first == pytest.approx(20.0 * math.tan(angle), abs=1e-8)
    assert {e.element for e in run.events if e.before == "locked" and e.time < first + 1e-9} == {moves, "v.rolling"}
    assert np.all(run["car.speed"][run.time < first] == 0.0)
    _balanced(run)


def test_a_wheel_on_a_support_that_turns() -> None:
    """The slip counts from the support, which takes the reaction R F."""
    d = cw.Driveline("swing")
    arm, axle = d.shaft("arm", inertia=50.0, speed=2.0), d.shaft("axle", inertia=INERTIA, speed=30.0)
    car = d.mass("car", mass=MASS)
    d.add(cw.RollingContact("tyre", shaft=axle, mass=car, support=arm, radius=RADIUS, friction=GRIP, load=LOAD))
    run = d.simulate(2.0, **TIGHT)
    force = 0.7 * LOAD
    rate = force * (RADIUS**2 / INERTIA + RADIUS**2 / 50.0 + 1 / MASS)
    assert run.events[0].time == pytest.approx(28.0 * RADIUS / rate, abs=EXACT)
    at_rest = run["car.speed"] - RADIUS * (run["axle.speed"] - run["arm.speed"])
    assert np.allclose(at_rest[run.time > run.events[0].time + 1e-9], 0.0, atol=1e-12)
    _balanced(run)


def test_a_wheel_that_lifts_off_slides_until_it_lands() -> None:
    """Without load the wheel turns freely: its brake stops it, on landing it is dragged up to speed."""
    load = cw.Table([(0.0, LOAD), (1.0, LOAD), (1.0, 0.0), (2.0, 0.0), (2.0, LOAD)])
    d, axle, _ = _car(speed=20.0, load=load)
    press = cw.Table([(1.0, 0.0), (1.0, 400.0), (2.0, 400.0), (2.0, 0.0)])
    d.add(cw.Brake("brake", shaft=axle, friction=cw.Coulomb(static=1.0, kinetic=1.0), gain=1.0, normal_force=press))
    run = d.simulate(3.0, **TIGHT)
    stop = 1.0 + 20.0 / RADIUS * INERTIA / 400.0
    assert next(e for e in run.events if e.element == "brake" and e.after == "locked").time == pytest.approx(stop)
    force = 0.7 * LOAD
    again = 2.0 + 20.0 / (force * (RADIUS**2 / INERTIA + 1 / MASS))
    assert [e.time for e in run.events if e.element == "tyre"][-1] == pytest.approx(again, abs=EXACT)
    _balanced(run)


@pytest.mark.parametrize("seed", seeds(20))
def test_random_drives_and_brakings_are_those_of_masses_alone(seed: int) -> None:
    """The wheel as a mass J/R^2, its torques over R: a clutch between two masses without gear and rim."""
    rng = np.random.default_rng(seed)
    times = np.arange(0.0, 6.01, 0.5)
    drive = [(float(t), float(y)) for t, y in zip(times, rng.uniform(-5000.0, 6000.0, len(times)), strict=True)]
    press = [(float(t), float(y)) for t, y in zip(times, rng.uniform(-3000.0, 6000.0, len(times)), strict=True)]
    weight = [(float(t), float(y)) for t, y in zip(times, rng.uniform(-2000.0, LOAD, len(times)), strict=True)]
    pads, coefficient = cw.Coulomb(static=1.0, kinetic=0.8), float(rng.uniform(0.005, 0.05))
    start = float(rng.uniform(-5.0, 20.0))
    d, axle, car = _car(speed=start, load=cw.Table(weight))
    d.add(cw.Torque("drive", shaft=axle, torque=cw.Table(drive)))
    d.add(cw.Brake("brake", shaft=axle, friction=pads, gain=1.0, normal_force=cw.Table(press)))
    e = cw.Driveline("masses")
    wheel, other = e.mass("wheel", mass=INERTIA / RADIUS**2, speed=start), e.mass("car", mass=MASS, speed=start)
    e.add(cw.Clutch("tyre", base=wheel, follower=other, friction=GRIP, gain=1.0, normal_force=cw.Table(weight)))
    force = cw.Table([(t, y / RADIUS) for t, y in drive])
    e.add(cw.Torque("drive", shaft=wheel, torque=force))
    e.add(cw.Brake("brake", shaft=wheel, friction=pads, gain=1 / RADIUS, normal_force=cw.Table(press)))
    for model, mass in ((d, car), (e, other)):
        model.add(cw.Vehicle("v", mass=mass, rolling_coefficient=coefficient, drag_area=2.0))
    run, same = (model.simulate(6.0, dt=0.05, rtol=1e-10) for model in (d, e))
    # 1e-7: both runs have an error of about 1e-9 at each of some 30 events
    assert np.allclose(run["car.speed"], same["car.speed"], rtol=0.0, atol=1e-7)
    assert np.allclose(RADIUS * run["axle.speed"], same["wheel.speed"], rtol=0.0, atol=1e-7)
    assert np.array_equal(run["tyre.mode"], same["tyre.mode"])
    _balanced(run)
