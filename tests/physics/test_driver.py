"""Drivers: pedals that follow the error, an integral that does not wind up, cycles of stages."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from support.runs import TIGHT

MASS, DRIVE, BRAKE = 1500.0, 4e3, 9e3
GAINS = {"gain": 0.8, "integral_gain": 0.1, "lag": 0.1}


def _car(cycle: Any) -> cw.Driveline:
    """A mass that a fast belt drags along by the accelerator and that a brake stops."""
    d = cw.Driveline("cycle")
    car, belt = d.mass("car", mass=MASS, speed=2.0), d.mass("belt", mass=1.0)
    driver = cw.Driver("driver", cycle=cycle, speed=car, **GAINS)
    grip = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(driver)
    d.add(cw.PrescribedSpeed("motor", shaft=belt, speed=100.0))
    d.add(cw.Clutch("drive", base=belt, follower=car, friction=grip, gain=DRIVE, normal_force=driver))
    d.add(cw.Brake("brake", shaft=car, friction=grip, gain=BRAKE, normal_force=(driver, "brake")))
    d.add(cw.AirDrag("air", shaft=car, area=0.7))
    return d


def _solved(points: list[tuple[float, float]], times: Any) -> Any:
    """SciPy over speed, pedals and integral, from kink to kink of the cycle."""
    t_points, values = zip(*points, strict=True)

    def slope(t: float, y: Any) -> list[float]:
        v, a, b, sum_ = y
        error = np.interp(t, t_points, values) - v
        u = GAINS["gain"] * error + sum_
        held = (sum_ >= 1.0 and error > 0.0) or (sum_ <= -1.0 and error < 0.0)
        force = DRIVE * a - BRAKE * b - 0.6 * 0.7 * v * abs(v)
        pedals = ((min(max(u, 0.0), 1.0) - a) / GAINS["lag"], (min(max(-u, 0.0), 1.0) - b) / GAINS["lag"])
        return [force / MASS, *pedals, 0.0 if held else GAINS["integral_gain"] * error]

    return solve_ivp(
        slope, (0.0, times[-1]), [2.0, 0.0, 0.0, 0.0], method="DOP853", rtol=1e-11, atol=1e-12, max_step=2e-3,
        t_eval=times,
    ).y  # fmt: skip


@pytest.mark.parametrize(
    "points",
    [
        [(0.0, 2.0), (5.0, 12.0), (9.0, 12.0), (13.0, 4.0), (16.0, 6.0)],
        # faster than it can: full pedal, the integral at its end
        [(0.0, 2.0), (0.5, 40.0), (10.0, 40.0), (11.0, 9.0), (18.0, 9.0)],
    ],
)
def test_speed_and_pedals_against_an_independent_solution(points: list[tuple[float, float]]) -> None:
    times = np.arange(0.0, points[-1][0] + 0.01, 0.25)
    run = _car(cw.Table(points)).simulate(times[-1], times=times, **TIGHT)
    made = _solved(points, run.time)
    # SciPy runs over kinks in steps of 2 ms
    for name, row in zip(("car.speed", "driver.throttle", "driver.brake", "driver.integral"), made, strict=True):
        assert np.allclose(run[name], row, rtol=0.0, atol=2e-5), name
    assert np.min(run["car.speed"]) > 0.0


def test_the_integral_does_not_wind_up() -> None:
    """It stays at its end while the cycle is ahead, and leaves it where the error turns."""
    cycle = cw.Table([(0.0, 40.0), (20.0, 40.0), (40.0, 0.0), (60.0, 0.0)])
    run = _car(cycle).simulate(60.0, **TIGHT)
    assert np.max(run["driver.integral"]) == pytest.approx(1.0, abs=1e-11)
    error = run["driver.cycle"] - run["car.speed"]
    top = run["driver.integral"] == 1.0
    assert np.min(error[top]) >= -1e-9
    leaves = run.time[np.flatnonzero(top)[-1]]
    turns = run.time[np.flatnonzero((error < -1e-9) & (run.time > 1.0))[0]]
    assert leaves <= turns
    assert turns - leaves < 0.2
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_a_cycle_of_stages() -> None:
    cycle = cw.drive_cycle([(10.0, 5.0, 3.0), (4.0, 2.0, 0.0), (0.0, 2.0, 1.0)], start=1.0)
    assert list(cycle.points) == [(1.0, 0.0), (6.0, 10.0), (9.0, 10.0), (11.0, 4.0), (13.0, 0.0), (14.0, 0.0)]
    with pytest.raises(cw.UseError, match="stage 1 takes 0 s to 10 m/s"):
        cw.drive_cycle([(10.0, 0.0, 3.0)])
    with pytest.raises(cw.UseError, match=r"stage 1 is .*three plain numbers"):
        cw.drive_cycle([(10.0, 5.0)])  # type: ignore[list-item]


@pytest.mark.parametrize("height", [10.0, 1e-3])
def test_a_cycle_that_rises_from_standstill_at_once(height):
    """Without error at the start the foot leaves the brake, which never had a force."""
    d = cw.Driveline("off")
    car = d.mass("car", mass=MASS)
    driver = d.add(cw.Driver("driver", cycle=cw.Table([(0.0, 0.0), (10.0, height)]), speed=car, **GAINS))
    grip = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Brake("brake", shaft=car, friction=grip, gain=BRAKE, normal_force=(driver, "brake")))
    run = d.simulate(3.0)
    assert run.time[-1] == 3.0
    assert not run.events
    assert np.all(run["driver.brake"] == 0.0)
    assert np.all(run["driver.throttle"] >= 0.0)


def test_a_cycle_that_falls_at_once_never_opens_the_throttle():
    d = cw.Driveline("slower")
    car = d.mass("car", mass=MASS, speed=10.0)
    driver = d.add(cw.Driver("driver", cycle=cw.Table([(0.0, 10.0), (10.0, 5.0)]), speed=car, **GAINS))
    grip = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Brake("brake", shaft=car, friction=grip, gain=BRAKE, normal_force=(driver, "brake")))
    run = d.simulate(3.0)
    early = run.time < 0.5
    assert np.all(run["driver.throttle"][early] == 0.0)
    assert run["driver.brake"][early].max() > 0.0


def test_a_message_names_the_motor_that_was_written() -> None:
    d = cw.Driveline()
    rotor, car = d.shaft("rotor", inertia=1.0), d.mass("car", mass=1e3)
    driver = d.add(cw.Driver("driver", cycle=10.0, speed=car))
    d.add(cw.ElectricMotor("motor", shaft=rotor, command=driver, max_torque=200.0))
    words = "cw.ElectricMotor(\"motor\"): command must be in [N m], but 'driver' gives [1]; give a signal in [N m]"
    assert words in str(d.check()[0])
