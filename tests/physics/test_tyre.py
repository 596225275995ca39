"""Tyre by the Magic Formula: steady slip, rest on a grade, spin at standstill, and a launch by SciPy."""

from __future__ import annotations

from math import atan, cos, pi, sin
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw

RADIUS, MASS, WEIGHT = 0.3, 1500.0, 1500.0 * 9.81
B, C, D, E, LENGTH = 10.0, 1.65, 1.0, 0.3, 0.25


def formula(x: float, load: float) -> float:
    """Force at a slip ratio."""
    return load * D * sin(C * atan(B * x - E * (B * x - atan(B * x))))


def rig(speed: float, wheel: float, time: float = 2.0, **tyre: Any) -> cw.Trajectory:
    """Speeds of tread and mass prescribed."""
    d = cw.Driveline("rig")
    shaft, mass = d.shaft("wheel", inertia=1.0), d.mass("car", mass=MASS)
    d.add(cw.PrescribedSpeed("belt", shaft=mass, speed=speed))
    d.add(cw.PrescribedSpeed("drum", shaft=shaft, speed=wheel / RADIUS))
    values = {"load": 4000.0, "low_speed_damping": 2000.0} | tyre
    d.add(cw.Tyre("tyre", shaft=shaft, mass=mass, radius=RADIUS, **values))
    return d.simulate(time, rtol=1e-9, atol=1e-9)


def car(grade: float = 0.0, speed: float = 0.0, torque: Any = 0.0, brake: float = 0.0, **tyre: Any) -> cw.Driveline:
    """A car on one driven wheel."""
    d = cw.Driveline("car")
    wheel, body = d.shaft("wheel", inertia=2.0, speed=speed / RADIUS), d.mass("car", mass=MASS, speed=speed)
    d.add(cw.Torque("drive", shaft=wheel, torque=torque))
    d.add(cw.Torque("weight", shaft=body, torque=-WEIGHT * sin(atan(grade))))
    if brake:
        friction = cw.Coulomb(static=0.4, kinetic=0.4)
        d.add(cw.Brake("brake", shaft=wheel, friction=friction, gain=1.0, normal_force=brake))
    values = {"load": WEIGHT, "low_speed_damping": 3000.0} | tyre
    d.add(cw.Tyre("tyre", shaft=wheel, mass=body, radius=RADIUS, **values))
    return d


@pytest.mark.parametrize("speed", [20.0, -20.0])
@pytest.mark.parametrize("ratio", [-1.0, -0.1, 0.02, 0.3, 1.5])
def test_steady_slip(speed: float, ratio: float) -> None:
    slip = ratio * abs(speed)
    run = rig(speed, speed + slip)
    # after 160 relaxation lengths
    assert run["tyre.torque"][-1] == pytest.approx(formula(ratio, 4000.0), rel=1e-8)
    assert run["drum.torque"][-1] == pytest.approx(RADIUS * formula(ratio, 4000.0), rel=1e-8)
    assert run["tyre.rate"][-1] == pytest.approx(-slip, rel=1e-12)


def test_the_force_builds_up_over_the_relaxation_length() -> None:
    run = rig(20.0, 20.2, time=0.02)
    travelled = 20.0 * 0.02
    assert run["tyre.deflection"][-1] == pytest.approx(LENGTH * 0.01 * (1.0 - np.exp(-travelled / LENGTH)), rel=1e-8)


@pytest.mark.parametrize("slip", [3.0, -3.0])
def test_a_wheel_that_spins_at_standstill_saturates(slip: float) -> None:
    run = rig(0.0, slip, low_speed_damping=0.0)
    # the slip carries the tread along at half its speed
    ratio = 2.0 * np.sign(slip) * (1.0 - np.exp(-0.5 * abs(slip) / LENGTH * run.time))
    assert run["tyre.deflection"] == pytest.approx(ratio * LENGTH, abs=1e-7)
    assert run["tyre.torque"][-1] == pytest.approx(formula(ratio[-1], 4000.0), rel=1e-6)


def test_at_rest_it_is_a_damped_spring() -> None:
    # small swings of the body on the standing wheel
    stiffness, damping = B * C * D * WEIGHT / LENGTH, 3000.0
    d = car(brake=1e6)
    run = cw.simulate(d.assemble().changed({"car.speed": 1e-4, "wheel.speed": 0.0}), 0.4, rtol=1e-10, atol=1e-14)
    w, decay = np.sqrt(stiffness / MASS - (damping / (2 * MASS)) ** 2), damping / (2 * MASS)
    t = run.time
    expected = 1e-4 / w * np.exp(-decay * t) * np.sin(w * t)
    # what the rolling of the tread takes off is of second order in the deflection over its length
    assert run["car.position"] == pytest.approx(expected, abs=2e-4 * np.max(expected))


def test_on_a_grade_it_neither_creeps_nor_drifts() -> None:
    run = car(grade=0.1, brake=5e4).simulate(600.0, rtol=1e-8, atol=1e-10)
    late = run.time > 60.0
    force = WEIGHT * sin(atan(0.1))
    assert run["tyre.torque"][-1] == pytest.approx(force, rel=1e-8)
    # less than a nanometre in nine minutes
    assert np.ptp(run["car.position"][late]) < 1e-9
    assert np.max(np.abs(run["car.speed"][late])) < 1e-10


def test_a_launch_agrees_with_scipy() -> None:
    d = car(torque=2500.0)

    def slope(_: float, y: np.ndarray) -> list[float]:
        w, v, u = y
        slip = RADIUS * w - v
        carried = max(abs(v), abs(slip) / 2.0)
        damping = 3000.0 * (1.0 + cos(pi * v / 2.5)) / 2.0 if abs(v) < 2.5 else 0.0
        force = formula(u / LENGTH + damping * slip / (B * C * D * WEIGHT), WEIGHT)
        return [(2500.0 - RADIUS * force) / 2.0, force / MASS, slip - carried * u / LENGTH]

    found = solve_ivp(slope, (0.0, 3.0), [0.0, 0.0, 0.0], method="DOP853", rtol=1e-11, atol=1e-12, max_step=1e-3)
    run = d.simulate(3.0, rtol=1e-10, atol=1e-10)
    assert run["car.speed"][-1] == pytest.approx(found.y[1, -1], rel=1e-7)
    assert run["wheel.speed"][-1] == pytest.approx(found.y[0, -1], rel=1e-7)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_a_car_stops_and_stands() -> None:
    run = car(speed=20.0, brake=6000.0).simulate(20.0, rtol=1e-9, atol=1e-9)
    assert run.finished
    assert abs(run["car.speed"][-1]) < 1e-7
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    # the brake and the tyre have taken what the car had
    assert sum(run.energy.heat.values()) == pytest.approx(0.5 * (MASS + 2.0 / RADIUS**2) * 20.0**2, rel=1e-6)


def test_off_the_road_it_has_no_force_and_comes_back_straight() -> None:
    lift = cw.Table([(0.0, WEIGHT), (0.5, WEIGHT), (0.6, -100.0), (0.8, -100.0), (0.9, WEIGHT)])
    run = car(speed=10.0, torque=500.0, load=lift).simulate(1.5, rtol=1e-9, atol=1e-9)
    air = (run.time > 0.6) & (run.time < 0.8)
    assert not np.any(run["tyre.torque"][air])
    assert not np.any(run["tyre.deflection"][air])
    assert run["tyre.torque"][-1] > 500.0
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_reactions_stand_at_the_support() -> None:
    d = cw.Driveline("carried")
    wheel, body = d.shaft("wheel", inertia=1.0, speed=0.0), d.mass("car", mass=MASS)
    frame = d.shaft("frame", inertia=50.0)
    d.add(cw.Torque("drive", shaft=wheel, base=frame, torque=400.0))
    d.add(cw.Spring("mount", base=d.housing, follower=frame, stiffness=1e6))
    d.add(cw.Tyre("tyre", shaft=wheel, mass=body, support=frame, radius=RADIUS, load=WEIGHT, low_speed_damping=3e3))
    run = d.simulate(1.0, rtol=1e-9, atol=1e-9)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    assert run["housing.force"][-1] == pytest.approx(0.0, abs=1e-12)


def test_a_shape_factor_that_turns_the_force_round_is_a_mistake():
    d = cw.Driveline()
    wheel, car = d.shaft("wheel", inertia=1.0), d.mass("car", mass=1e3)
    d.add(cw.Tyre("t", shaft=wheel, mass=car, radius=0.3, load=4e3, low_speed_damping=1e3, C=2.5))
    with pytest.raises(cw.ModelError, match=r"C = 2.5: must be > 0 and <= 2"):
        d.assemble()
