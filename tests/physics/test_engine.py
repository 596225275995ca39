"""The engine: torque, lag, boost, ripple, stall and rest, against closed forms and SciPy."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from clutchwork.elements.engine import RIPPLE_BAND
from support.project import ROOT

FINE = {"rtol": 1e-9, "atol": 1e-11}
FULL, DRAG = [(80.0, 100.0), (200.0, 220.0), (400.0, 240.0), (600.0, 180.0)], [(0.0, -20.0), (600.0, -60.0)]
BARE = [(80.0, 90.0), (300.0, 140.0), (600.0, 120.0)]
SPEEDS, THROTTLES = (50.0, 200.0, 400.0, 600.0), (0.0, 0.2, 0.5, 1.0)
MAP = (
    (-20.0, 50.0, 80.0, 100.0),
    (-25.0, 80.0, 160.0, 220.0),
    (-35.0, 60.0, 170.0, 240.0),
    (-50.0, 20.0, 100.0, 180.0),
)


def _at(points, w):
    return float(np.interp(w, *zip(*points, strict=True)))


def _driveline(speed, throttle, inertia=0.2, **more):
    d = cw.Driveline()
    shaft = d.shaft("s", inertia=inertia, speed=speed)
    curves = {} if "torques" in more else {"full_load": FULL, "motoring": DRAG}
    d.add(cw.Engine("e", shaft=shaft, throttle=throttle, **(curves | more)))
    return d


def _prescribed(speed, throttle, times, **more):
    d = cw.Driveline()
    shaft = d.shaft("s")
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=speed))
    curves = {} if "torques" in more else {"full_load": FULL, "motoring": DRAG}
    d.add(cw.Engine("e", shaft=shaft, throttle=throttle, **(curves | more)))
    return d.simulate(times[-1], times=times, **FINE)


def _sound(run):
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    return run


def test_torque_follows_the_throttle_between_both_curves():
    times = np.linspace(0.0, 1.0, 401)
    throttle = cw.Ramp(height=1.0, duration=1.0)
    run = _prescribed(cw.Ramp(height=720.0, duration=1.0, offset=10.0), throttle, times)
    known = [_at(DRAG, w) + t * (_at(FULL, w) - _at(DRAG, w)) for t, w in zip(times, run["s.speed"], strict=True)]
    np.testing.assert_allclose(run["e.torque"], known, atol=1e-9)


def test_torque_map_is_bilinear_and_held_outside():
    times = np.linspace(0.0, 1.0, 1201)
    throttle = cw.Sine(amplitude=0.55, offset=0.55, frequency=7.0)
    run = _prescribed(
        cw.Ramp(height=700.0, duration=1.0), throttle, times, speeds=SPEEDS, throttles=THROTTLES, torques=MAP
    )
    known = []
    for t, w in zip(times, run["s.speed"], strict=True):
        u = min(0.55 + 0.55 * math.sin(14 * math.pi * t), 1.0)
        known.append(np.interp(w, SPEEDS, [np.interp(u, THROTTLES, row) for row in MAP]))
    # the friction of rest changes its sign with the speed
    np.testing.assert_allclose(run["e.torque"][1:], known[1:], atol=1e-8)


def test_lag_and_boost_meet_their_closed_forms():
    """At a constant speed both are linear: a first and a second order."""
    lag, slow = 0.1, 0.5
    times = np.linspace(0.0, 2.0, 201)
    run = _prescribed(300.0, 1.0, times, lag=lag, naturally_aspirated=BARE, boost_lag=slow)
    u = 1 - np.exp(-times / lag)
    b = 1 - (slow * np.exp(-times / slow) - lag * np.exp(-times / lag)) / (slow - lag)
    np.testing.assert_allclose(run["e.opening"], u, atol=1e-8)
    np.testing.assert_allclose(run["e.boost"], b, atol=1e-8)
    full = _at(BARE, 300.0) + b * (_at(FULL, 300.0) - _at(BARE, 300.0))
    np.testing.assert_allclose(run["e.torque"], _at(DRAG, 300.0) + u * (full - _at(DRAG, 300.0)), atol=1e-6)


def test_a_closed_throttle_coasts_down_and_holds_the_engine_at_rest():
    """Drag -(20 + w/15) N m: an exponential in finite time; then it holds 20 N m and no more."""
    inertia, slope, still = 0.2, 40.0 / 600.0, 20.0
    d = _driveline(100.0, 0.0, inertia, stall_speed=60.0)
    d.add(cw.Torque("load", shaft=d.nodes[0], torque=cw.Ramp(height=-40.0, duration=4.0, start=2.0)))
    run = _sound(d.simulate(5.0, **FINE))
    stop = inertia / slope * math.log(1 + slope * 100.0 / still)
    locked, broken = (next(e for e in run.events if e.after == mode) for mode in ("locked", "backward"))
    assert locked.time == pytest.approx(stop, abs=1e-9)
    # -10 N m/s from 2 s on
    assert broken.time == pytest.approx(2.0 + still / 10.0, abs=1e-9)
    assert np.all(run["s.speed"][(run.time > stop + 1e-6) & (run.time < 4.0 - 1e-6)] == 0.0)
    # backward the drag is mirrored: -(still + slope abs(w)) against it
    assert run["e.torque"][-1] == pytest.approx(still - slope * run["s.speed"][-1], rel=1e-9)


@pytest.mark.parametrize("method", ["rodas5p", "dopri5"])
@pytest.mark.parametrize("end", [2.0, 3.0])
@pytest.mark.parametrize("lag", [0.0, 0.05])
def test_what_a_regularised_brake_has_brought_to_rest_fires_again(method, end, lag):
    """Its speed dies away on either side of zero, where in reverse nothing burns: then the throttle opens, at once or
    within a second."""
    inertia, brake, torque = 0.2, 3.0, 5.0
    d = cw.Driveline("again")
    s = d.shaft("s", inertia=inertia, speed=5.0)
    throttle = cw.Table([(0.0, 0.0), (2.0, 0.0), (end, 1.0), (4.0, 1.0)])
    d.add(cw.Engine("e", shaft=s, full_load=[(0.0, torque), (100.0, torque)], throttle=throttle, lag=lag))
    law = cw.Tanh(kinetic=0.1, speed=0.15)
    d.add(cw.Brake("b", shaft=s, friction=law, gain=1.0, normal_force=brake / 0.1))
    run = d.simulate(4.0, method=method)
    exact = d.simulate(4.0, **FINE)
    assert run["e.torque"][-1] == pytest.approx(torque, rel=1e-6)
    # from rest on 2 N m of 5 are left, but for those of the throttle that the brake holds
    assert run["s.speed"][-1] == pytest.approx(exact["s.speed"][-1], rel=1e-5)
    assert run["s.speed"][-1] > (torque - brake) / inertia * (4.0 - end) - torque * lag / inertia


def test_nothing_burns_below_the_stall_speed():
    run = _sound(
        _driveline(100.0, cw.Step(height=-1.0, start=0.05, offset=1.0), stall_speed=90.0).simulate(3.0, **FINE)
    )
    assert run["s.speed"][-1] == 0.0
    torque = [_driveline(w, 1.0, stall_speed=90.0).simulate(1e-4)["e.torque"][0] for w in (89.9, 90.1, 0.0, -5.0)]
    assert torque == pytest.approx([_at(DRAG, 89.9), _at(FULL, 90.1), 0.0, 20.0 + 5.0 / 15.0], rel=1e-12)


def test_the_mean_of_the_ripple_over_two_revolutions_is_that_without_it():
    speed, orders = 150.0, (0.5, 2.0, 4.0)
    turns = 4 * math.pi / speed
    times = np.linspace(0.0, turns, 4001)
    ripple = {"orders": orders, "amplitudes": (0.2, 1.4, 0.6), "phases": (0.3, -1.0, 2.0)}
    plain, waved = (_prescribed(speed, 0.6, times, **more) for more in ({}, ripple))
    assert waved["e.work"][-1] == pytest.approx(plain["e.work"][-1], rel=1e-8)
    burning = 0.6 * (_at(FULL, speed) - _at(DRAG, speed))
    wave = sum(a * np.cos(n * speed * times + p) for n, a, p in zip(*ripple.values(), strict=True))
    np.testing.assert_allclose(waved["e.torque"], plain["e.torque"] + burning * wave, atol=1e-7 * burning)


def test_ripple_excites_two_masses_as_the_frequency_response_says():
    j1, j2, k, damping, speed, amplitude = 0.3, 4.0, 2e4, 6.0, 120.0, 0.05
    torque = 100.0
    d = cw.Driveline()
    engine, car = d.shaft("engine", inertia=j1, speed=speed), d.shaft("car", inertia=j2, speed=speed)
    flat = [(0.0, torque), (1.0, torque)]
    d.add(cw.Engine("e", shaft=engine, throttle=1.0, full_load=flat, orders=(2.0,), amplitudes=(amplitude,)))
    d.add(cw.SpringDamper("k", base=car, follower=engine, stiffness=k, damping=damping, initial_twist=torque / k))
    d.add(cw.Torque("load", shaft=car, torque=-torque))
    run = d.simulate(6.0, times=np.linspace(5.5, 6.0, 4001), rtol=1e-8, atol=1e-10)
    twist, omega = run["engine.angle"] - run["car.angle"], 2.0 * np.mean(run["engine.speed"])
    both = j1 * j2 / (j1 + j2)
    known = amplitude * torque / j1 / abs(complex(k / both - omega**2, damping * omega / both))
    # samples of 0.125 ms of a wave of 26 ms; its frequency follows the speed, which ripples by 0.2 %
    assert 0.5 * np.ptp(twist) == pytest.approx(known, rel=5e-3)


@pytest.mark.parametrize("seed", range(6))
def test_random_engines_against_scipy(seed):
    g = np.random.default_rng(seed)
    lag, inertia, w0, slow = g.uniform(0.02, 0.2), g.uniform(0.1, 0.6), g.uniform(80.0, 500.0), g.uniform(0.2, 1.0)
    amplitude, frequency, load = g.uniform(0.1, 0.5), g.uniform(0.3, 2.0), g.uniform(0.0, 60.0)
    size, phase, top, band = g.uniform(0.0, 0.8), g.uniform(0.0, 6.0), g.uniform(400.0, 550.0), g.uniform(20.0, 80.0)
    d = _driveline(
        w0,
        cw.Sine(amplitude=amplitude, offset=0.5, frequency=frequency),
        inertia,
        lag=lag,
        naturally_aspirated=BARE,
        boost_lag=slow,
        orders=(2.0,),
        amplitudes=(size,),
        phases=(phase,),
        max_speed=top,
        limit_band=band,
        stall_speed=40.0,
    )
    d.add(cw.QuadraticTorque("load", shaft=d.nodes[0], nominal_torque=-load, nominal_speed=300.0))
    run = _sound(d.simulate(1.5, times=np.linspace(0.0, 1.5, 101), **FINE))

    def slope(t, y):
        w, u, b, angle = y
        low, high, bare = (_at(points, w) for points in (DRAG, FULL, BARE))
        burning = u * (bare + b * (high - bare) - low) * (1 + size * math.cos(2 * angle + phase))
        torque = low + burning * (w >= 40.0) - load * (w / 300.0) ** 2
        wanted = min(0.5 + amplitude * math.sin(2 * math.pi * frequency * t), np.clip((top - w) / band, 0.0, 1.0))
        return torque / inertia, (wanted - u) / lag, (u - b) / slow, w

    start = (w0, 0.0, 0.0, 0.0)
    known = solve_ivp(slope, (0.0, 1.5), start, t_eval=run.time, rtol=1e-10, atol=1e-10, max_step=1e-3, method="DOP853")
    assert np.all(known.y[0] > 40.0)
    # steps of 1 ms across kinks leave some 1e-6 of full scale
    np.testing.assert_allclose(run["s.speed"], known.y[0], atol=2e-6 * np.abs(known.y[0]).max())
    np.testing.assert_allclose(run["e.opening"], known.y[1], atol=2e-6)
    np.testing.assert_allclose(run["e.boost"], known.y[2], atol=2e-6)


def test_states_that_nobody_asked_for_are_not_there():
    names = set(_driveline(100.0, 0.5).simulate(0.01).names)
    assert not names & {"e.opening", "e.idle", "e.boost", "e.crank"}
    assert {"e.torque", "e.power", "e.throttle", "e.drag.state"} <= names


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"full_load": None}, r"full_load.*is missing"),
        ({"torques": MAP, "full_load": FULL}, r"belongs to a torque map"),
        ({"torques": MAP, "speeds": SPEEDS}, r"throttles.*is missing"),
        ({"torques": MAP, "speeds": SPEEDS, "throttles": (0.1, 0.5)}, r"must start at 0"),
        ({"motoring": [(0.0, 5.0)]}, r"reaches 5 N m"),
        ({"idle_speed": 80.0}, r"has no control"),
        ({"max_speed": 5.0}, r"not below max_speed"),
        ({"orders": (2.2,), "amplitudes": (1.0,)}, r"not a multiple of 1/2"),
        ({"orders": (2.0,)}, r"must have as many numbers as orders, 1"),
        ({"phases": (2.0,)}, r"needs orders"),
    ],
    ids=str,
)
def test_mistakes_are_named(values, words):
    d = cw.Driveline()
    shaft = d.shaft("s", inertia=1.0)
    given = {"throttle": 0.0} | ({} if "torques" in values else {"full_load": FULL}) | values
    d.add(cw.Engine("e", shaft=shaft, **given))
    with pytest.raises(cw.ModelError, match=words):
        d.assemble()


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"stall_speed": 40.0}, r"stall_speed.*40\.0 rad/s, which is none of speeds"),
        ({"limiter": "band", "max_speed": 50.0, "limit_band": 8.0}, r"limit_band.*42\.0 rad/s"),
        ({"limiter": "band", "max_speed": 120.0, "limit_band": 20.0}, r"max_speed.*120\.0 rad/s"),
    ],
    ids=str,
)
def test_borders_of_the_part_are_on_its_grid(values, words):
    """Between two speeds of its grid the limiter, and the stall, would begin at one of them: with a jump."""
    d = cw.Driveline()
    grid = {"speeds": (0.0, 50.0, 100.0), "throttles": (0.0, 1.0), "deficit": (0.0,) * 3}
    rest = {"torques": ((0.0, 9.0),) * 3, "orders": (1.0,), "amplitudes": (0.0,), "phases": (0.0,), "throttle": 1.0}
    d.add(cw.EngineTorque("e", shaft=d.shaft("s", inertia=1.0), **grid, **rest, **values))
    with pytest.raises(cw.ModelError, match=words):
        d.assemble()


def test_the_band_of_the_ripple_is_that_of_the_core():
    # the composite has a knot of its map where the ripple of the part ends
    header = (ROOT / "cpp/include/clutchwork/elements/engine_torque.hpp").read_text(encoding="utf-8")
    assert [float(x) for x in re.findall(r"ripple_band = ([\d.]+);", header)] == [RIPPLE_BAND]
