"""Idle control and speed limiter of the engine against event-driven SciPy and closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

import clutchwork as cw
from reference import switched

FINE = {"rtol": 1e-9, "atol": 1e-11}
TOP, LOW = 150.0, -30.0  # N m: full load and motoring
IDLE, GAIN, RATE, LIMIT = 80.0, 0.01, 0.1, 0.45
INERTIA, LAG = 0.15, 0.06
FLAT = {"full_load": [(0.0, TOP), (1.0, TOP)], "motoring": [(0.0, LOW), (1.0, LOW)]}
CONTROL = {"idle_speed": IDLE, "idle_gain": GAIN, "idle_integral": RATE, "idle_limit": LIMIT}


LOADS = (0.0, 45.0, 0.0)  # N m, from 0, 3 and 6 s on


def _driveline(speed, throttle=0.0, lag=LAG, **more):
    d = cw.Driveline()
    shaft = d.shaft("s", inertia=INERTIA, speed=speed)
    d.add(cw.Engine("e", shaft=shaft, throttle=throttle, lag=lag, **FLAT, **more))
    return d


def _idle_modes():
    """Speed, opening, integral: in each mode of the control, for each load."""

    def missing(y):
        return IDLE - y[0]

    def total(y):
        return GAIN * missing(y) + y[2]

    def slope(load, out, free):
        def f(t, y):
            torque = LOW + y[1] * (TOP - LOW) - load
            return torque / INERTIA, (out(y) - y[1]) / LAG, RATE * missing(y) if free else 0.0

        return f

    parts = {
        "rest": (lambda y: 0.0, False, ((lambda t, y: -missing(y), "moving"),)),
        "low": (lambda y: 0.0, True, ((lambda t, y: -total(y), "moving"), (lambda t, y: y[2], "rest"))),
        "moving": (total, True, ((lambda t, y: total(y), "low"), (lambda t, y: LIMIT - total(y), "high"))),
        "high": (
            lambda y: LIMIT,
            True,
            ((lambda t, y: total(y) - LIMIT, "moving"), (lambda t, y: LIMIT - y[2], "full")),
        ),
        "full": (lambda y: LIMIT, False, ((lambda t, y: missing(y), "moving"),)),
    }
    modes, knots = {}, (3.0, 6.0)
    for stretch, load in enumerate(LOADS):
        for name, (out, free, exits) in parts.items():
            ways = tuple((guard, f"{stretch}{to}") for guard, to in exits)
            if stretch < 2:
                ways = ((lambda t, y, s=stretch: knots[s] - t, f"{stretch + 1}{name}"), *ways)
            modes[f"{stretch}{name}"] = switched.Mode(slope(load, out, free), ways)
    return modes


def test_idle_control_recovers_from_load_steps_as_scipy_says():
    """From 150 rad/s through every mode: the integral rests, moves, is wound up to its limit and comes back."""
    d = _driveline(150.0, **CONTROL)
    load = cw.Table([(0.0, 0.0), (3.0, 0.0), (3.0, -LOADS[1]), (6.0, -LOADS[1]), (6.0, 0.0)])
    d.add(cw.Torque("load", shaft=d.nodes[0], torque=load))
    times = np.linspace(0.0, 9.0, 721)
    run = d.simulate(9.0, times=times, **FINE)
    known = switched.solve(_idle_modes(), "0rest", (150.0, 0.0, 0.0), times)
    visited = {mode[1:] for _, mode in known.changes}
    assert visited == {"rest", "low", "moving", "high", "full"}
    # 100 x the tolerance of the run, of full scale
    np.testing.assert_allclose(run["s.speed"], known.values[:, 0], atol=1e-7 * 150.0)
    np.testing.assert_allclose(run["e.opening"], known.values[:, 1], atol=1e-7)
    np.testing.assert_allclose(run["e.idle"], known.values[:, 2], atol=1e-7)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_the_steady_state_of_the_idle_control():
    run = _driveline(100.0, **CONTROL).simulate(30.0, **FINE)
    assert run["s.speed"][-1] == pytest.approx(IDLE, rel=1e-9)
    assert run["e.idle"][-1] == pytest.approx(-LOW / (TOP - LOW), rel=1e-8)


@pytest.mark.parametrize("gain", [GAIN, 0.0])
def test_the_projected_integral_does_not_drift(gain):
    """A given speed swings about idle: the integral is the same in each cycle, zero to the last bit where it rests."""
    d = cw.Driveline()
    shaft = d.shaft("s")
    swing, cycles = 8.0, 60
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=cw.Sine(amplitude=swing, offset=IDLE, frequency=1.0)))
    control = CONTROL | {"idle_gain": gain, "idle_limit": 1.0}
    d.add(cw.Engine("e", shaft=shaft, throttle=0.0, **FLAT, **control))
    times = np.linspace(0.0, cycles, 16 * cycles + 1)
    run = d.simulate(cycles, times=times, **FINE)
    # in the second half of each cycle the speed is missing: the integral rises to 2 A k/omega, and falls as far in the
    # first half of the next one
    phase = 2 * math.pi * times
    rise = RATE * swing / (2 * math.pi)
    known = np.where(times < 0.5, 0.0, rise * (1 + np.cos(phase)))
    np.testing.assert_allclose(run["e.idle"], known, atol=1e-9)
    assert run["e.idle"].min() >= -1e-12
    assert run["e.idle"][4] == 0.0
    # clipped at zero, whatever is missing
    out = np.clip(-gain * swing * np.sin(phase) + known, 0.0, 1.0)
    np.testing.assert_allclose(run["e.torque"], LOW + out * (TOP - LOW), atol=1e-6)


def test_the_integral_rests_at_its_upper_end_and_leaves_it_at_once():
    """Wound up for 10 s by a lack of speed, it starts to fall in the instant in which the speed is right."""
    d = cw.Driveline()
    shaft = d.shaft("s")
    speed = cw.Ramp(height=100.0, duration=10.0, offset=IDLE - 80.0)
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=speed))
    d.add(cw.Engine("e", shaft=shaft, throttle=0.0, **FLAT, **CONTROL))
    times = np.linspace(0.0, 10.0, 1001)
    run = d.simulate(10.0, times=times, **FINE)
    inside = (times > 1.0) & (times <= 8.0)
    # it stands still: round-off of the interpolant alone
    np.testing.assert_allclose(run["e.idle"][inside], LIMIT, rtol=1e-15)
    after = times > 8.0
    fall = 0.5 * RATE * 10.0 * (times[after] - 8.0) ** 2
    np.testing.assert_allclose(run["e.idle"][after], np.maximum(LIMIT - fall, 0.0), atol=1e-9)


def test_cut_cycles_have_the_times_of_their_closed_form():
    """Constant torques: the speed is a saw tooth between the limit and the band below it."""
    top, band = 500.0, 20.0
    run = _driveline(400.0, 1.0, lag=0.0, max_speed=top, limit_band=band, cut=True).simulate(
        2.0, rtol=1e-10, atol=1e-12
    )
    up, down = TOP / INERTIA, -LOW / INERTIA
    first, rise, fall = (top - 400.0) / up, band / up, band / down
    speed, t = run["s.speed"], run.time
    phase = np.mod(t - first, rise + fall)
    known = np.where(
        t < first,
        400.0 + up * t,
        np.where(phase < fall, top - down * phase, top - band + up * (phase - fall)),
    )
    np.testing.assert_allclose(speed, known, atol=1e-7)
    assert (2.0 - first) / (rise + fall) > 5.0
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_cut_cycles_with_a_lag_against_scipy():
    top, band = 500.0, 20.0
    times = np.linspace(0.0, 2.0, 401)
    run = _driveline(450.0, 1.0, max_speed=top, limit_band=band, cut=True).simulate(2.0, times=times, **FINE)

    def slope(wanted):
        return lambda t, y: ((LOW + y[1] * (TOP - LOW)) / INERTIA, (wanted - y[1]) / LAG)

    modes = {
        "on": switched.Mode(slope(1.0), ((lambda t, y: top - y[0], "off"),)),
        "off": switched.Mode(slope(0.0), ((lambda t, y: y[0] - (top - band), "on"),)),
    }
    known = switched.solve(modes, "on", (450.0, 0.0), times)
    assert len(known.changes) > 5
    np.testing.assert_allclose(run["s.speed"], known.values[:, 0], atol=1e-7 * 500.0)
    np.testing.assert_allclose(run["e.opening"], known.values[:, 1], atol=1e-7)


def test_the_band_of_the_limiter_settles_where_the_torque_is_that_of_the_load():
    top, band, load = 500.0, 30.0, 40.0
    d = _driveline(400.0, 1.0, max_speed=top, limit_band=band)
    d.add(cw.Torque("load", shaft=d.nodes[0], torque=-load))
    run = d.simulate(20.0, **FINE)
    share = (load - LOW) / (TOP - LOW)
    assert run["s.speed"][-1] == pytest.approx(top - band * share, rel=1e-8)


def test_the_larger_of_throttle_and_idle_counts():
    times = np.linspace(0.0, 2.0, 81)
    d = cw.Driveline()
    shaft = d.shaft("s")
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=70.0))
    control = {"idle_speed": IDLE, "idle_gain": 0.03}
    throttle = cw.Ramp(height=0.8, duration=2.0)
    d.add(cw.Engine("e", shaft=shaft, throttle=throttle, **FLAT, **control))
    run = d.simulate(2.0, times=times, **FINE)
    known = np.maximum(0.4 * times, 0.3)
    np.testing.assert_allclose(run["e.torque"], LOW + known * (TOP - LOW), atol=1e-9)


def test_an_integral_above_its_limit_is_refused():
    """It would rest beyond the end at which it is held, and leave that again and again."""
    d = cw.Driveline()
    shaft = d.shaft("s", inertia=INERTIA)
    grid = {"speeds": [0.0, 100.0], "throttles": [0.0, 1.0], "torques": [[LOW, TOP], [LOW, TOP]], "deficit": [0.0, 0.0]}
    control = {"governed": True, "idle_limit": 0.1, "initial_idle": 0.5}
    ripple = {"orders": [2.0], "amplitudes": [0.5], "phases": [0.0]}
    d.add(cw.EngineTorque("e", shaft=shaft, throttle=0.0, **grid, **control, **ripple))
    with pytest.raises(cw.ModelError, match=r"initial_idle is 0\.5, above idle_limit 0\.1"):
        d.simulate(0.1)
