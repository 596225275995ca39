"""The eddy-current brake against its closed form, and with a warm rotor against SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw

PEAK, SPEED, INERTIA, COLD = 100.0, 20.0, 1.5, 293.15


def _brake(d, shaft, **more):
    return d.add(cw.EddyCurrentBrake("b", shaft=shaft, nominal_torque=PEAK, nominal_speed=SPEED, **more))


def test_coast_down_at_constant_temperature_meets_its_closed_form():
    d = cw.Driveline()
    _brake(d, d.shaft("s", inertia=INERTIA, speed=90.0))
    run = d.simulate(2.0, rtol=1e-10, atol=1e-12)
    x, x0 = run["s.speed"] / SPEED, 90.0 / SPEED
    left = np.log(x / x0) + (x**2 - x0**2) / 2
    # sources-2; the logarithm loses one digit
    np.testing.assert_allclose(left, -2 * PEAK / (INERTIA * SPEED) * run.time, atol=1e-8)


def test_peak_torque_stands_at_its_speed_in_both_directions():
    d = cw.Driveline()
    shaft = d.shaft("s")
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=cw.Ramp(height=-200.0, duration=1.0, offset=100.0)))
    _brake(d, shaft)
    run = d.simulate(1.0, times=np.linspace(0.0, 1.0, 201))
    w, torque = run["s.speed"], run["b.torque"]
    assert w[np.argmin(torque)] == pytest.approx(SPEED)
    assert (torque.min(), torque.max()) == pytest.approx((-PEAK, PEAK), rel=1e-12)
    np.testing.assert_allclose(torque, -torque[::-1], atol=1e-9 * PEAK)


def test_a_warm_rotor_against_scipy():
    capacity, alpha = 30.0, 0.0039
    d = cw.Driveline()
    rotor = d.thermal("rotor", capacity=capacity, temperature=COLD)
    _brake(d, d.shaft("s", inertia=INERTIA, speed=90.0), temperature_coefficient=alpha, heat=rotor)
    run = d.simulate(3.0, rtol=1e-9, atol=1e-11)

    def slope(_, y):
        x = y[0] / (SPEED * (1 + alpha * (y[1] - COLD)))
        torque = -2 * PEAK * x / (1 + x * x)
        return torque / INERTIA, -torque * y[0] / capacity

    known = solve_ivp(slope, (0.0, 3.0), (90.0, COLD), t_eval=run.time, rtol=1e-11, atol=1e-11, method="DOP853")
    # 100 x the tolerance of the run, of full scale
    np.testing.assert_allclose(run["s.speed"], known.y[0], atol=1e-7 * 90.0)
    np.testing.assert_allclose(run["b.temperature"], known.y[1], atol=1e-7 * 500.0)
    assert run["rotor.heat"][-1] + 0.5 * INERTIA * run["s.speed"][-1] ** 2 == pytest.approx(0.5 * INERTIA * 90.0**2)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_the_temperature_may_be_a_signal():
    torques = []
    for temperature in (COLD, COLD + 100.0):
        d = cw.Driveline()
        _brake(d, d.shaft("s", inertia=1.0, speed=40.0), temperature_coefficient=0.004, temperature=temperature)
        torques.append(d.simulate(1e-3)["b.torque"][0])
    expected = [-2 * PEAK * x / (1 + x * x) for x in (2.0, 2.0 / 1.4)]
    assert torques == pytest.approx(expected, rel=1e-14)


def test_a_coefficient_without_a_temperature_is_a_mistake():
    d = cw.Driveline()
    _brake(d, d.shaft("s", inertia=1.0), temperature_coefficient=0.004)
    with pytest.raises(cw.ModelError, match=r"temperature_coefficient.*there is no temperature"):
        d.assemble()


def test_a_conductor_too_cold_for_its_coefficient_is_a_mistake():
    """Its resistance would be below zero, and the brake would drive."""
    d = cw.Driveline()
    _brake(d, d.shaft("s", inertia=1.0, speed=4.0), temperature_coefficient=0.01, temperature=COLD - 100.0)
    with pytest.raises(cw.ModelError, match=r"temperature is .* K, not above .* K.*give a higher one"):
        d.assemble()


def test_a_signal_that_falls_below_it_is_one_too():
    d = cw.Driveline()
    temperature = cw.Step(height=100.0, start=0.1, offset=COLD - 100.0)
    _brake(d, d.shaft("s", inertia=1.0, speed=4.0), temperature_coefficient=0.01, temperature=temperature)
    with pytest.raises(cw.ModelError, match=r"temperature is .* K, not above .* K.*give a higher one"):
        d.assemble()


def test_a_node_that_is_too_cold_leaves_it_no_resistance():
    """Its peak is at rest then, and no torque is left at a speed; it does not drive."""
    d = cw.Driveline()
    cold = d.ambient("cold", temperature=COLD - 100.0)
    _brake(d, d.shaft("s", inertia=1.0, speed=4.0), temperature_coefficient=0.02, heat=cold)
    run = d.simulate(0.1)
    assert np.all(run["b.torque"] == 0.0)
    assert run["s.speed"][-1] == 4.0
