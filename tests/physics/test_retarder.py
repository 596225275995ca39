"""The retarder on each of its branches against closed forms, with its lag against SciPy."""

from __future__ import annotations

import math

import numpy as np
import pytest

import clutchwork as cw
from reference import switched
from support.amount import amount
from support.sweep import simulate, stopped, sweep

CAPACITY, MOST, POWER, INERTIA = 0.05, 800.0, 1.2e5, 20.0
# ends of the branches [rad/s]: 126.5 and 150
RISE, FALL = math.sqrt(MOST / CAPACITY), POWER / MOST


def _size(w):
    return np.minimum(np.minimum(CAPACITY * w * w, MOST), POWER / np.maximum(np.abs(w), 1e-9))


def _driveline(speed, **more):
    d = cw.Driveline()
    shaft = d.shaft("s", inertia=INERTIA, speed=speed)
    d.add(cw.Retarder("r", shaft=shaft, capacity=CAPACITY, max_torque=MOST, max_power=POWER, **more))
    return d


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_spin_down_through_all_branches_meets_its_closed_form(side):
    run = _driveline(side * 250.0).simulate(20.0, times=np.linspace(0.0, 20.0, 401), rtol=1e-10, atol=1e-12)
    t, w = run.time, side * run["s.speed"]
    # power: w^2 falls linearly; torque: w does; capacity: 1/w rises
    first = INERTIA * (250.0**2 - FALL**2) / (2 * POWER)
    second = first + INERTIA * (FALL - RISE) / MOST
    known = np.where(
        t < first,
        np.sqrt(np.maximum(250.0**2 - 2 * POWER * t / INERTIA, 0.0)),
        np.where(
            t < second,
            FALL - MOST * (t - first) / INERTIA,
            1 / (1 / RISE + CAPACITY * np.maximum(t - second, 0) / INERTIA),
        ),
    )
    # 100 x the tolerance of the run, of full scale
    np.testing.assert_allclose(w, known, atol=1e-8 * 250.0)
    np.testing.assert_allclose(run["r.torque"], -side * _size(w), rtol=1e-12, atol=1e-12)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_a_power_that_is_reached_before_the_torque_leaves_two_branches():
    d = cw.Driveline()
    shaft = d.shaft("s")
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=cw.Ramp(height=400.0, duration=1.0, offset=-200.0)))
    d.add(cw.Retarder("r", shaft=shaft, capacity=CAPACITY, max_torque=MOST, max_power=5e4))
    run = d.simulate(1.0, times=np.linspace(0.0, 1.0, 101))
    w = run["s.speed"]
    known = np.minimum(CAPACITY * w * w, 5e4 / np.maximum(np.abs(w), 1e-9))
    np.testing.assert_allclose(run["r.torque"], -np.sign(w) * known, rtol=1e-12, atol=1e-9)
    assert known.max() < MOST


def test_filling_lags_against_scipy():
    lag, command = 0.4, cw.Table([(0.0, 0.2), (1.0, 0.2), (1.0, 1.0), (3.0, 0.0)])
    times = np.linspace(0.0, 4.0, 161)
    run = _driveline(165.0, lag=lag, command=command, initial_filling=0.1).simulate(
        4.0, times=times, rtol=1e-9, atol=1e-11
    )

    def mode(wanted, size, *exits):
        def slope(t, y):
            return -y[1] * size(y[0]) / INERTIA, (wanted(t) - y[1]) / lag

        return switched.Mode(slope, exits)

    branches = (lambda w: POWER / w, lambda w: MOST, lambda w: CAPACITY * w * w)
    signals = (lambda t: 0.2, lambda t: 1.0 - 0.5 * (t - 1.0), lambda t: 0.0)
    knots, borders = (1.0, 3.0), (FALL, RISE)
    modes = {}
    for s, wanted in enumerate(signals):
        for b, size in enumerate(branches):
            exits = []
            if s < 2:
                exits.append((lambda t, y, s=s: knots[s] - t, f"{s + 1}{b}"))
            if b < 2:
                exits.append((lambda t, y, b=b: y[0] - borders[b], f"{s}{b + 1}"))
            modes[f"{s}{b}"] = mode(wanted, size, *exits)
    known = switched.solve(modes, "00", (165.0, 0.1), times)
    assert known.changes[-1][1] == "22"
    # 100 x the tolerance of the run, of full scale
    np.testing.assert_allclose(run["s.speed"], known.values[:, 0], atol=1e-7 * 165.0)
    np.testing.assert_allclose(run["r.filling"], known.values[:, 1], atol=1e-7)


def test_without_a_lag_there_is_no_state():
    run = _driveline(100.0, command=0.5).simulate(0.1)
    assert "r.filling" not in run.names
    assert run["r.torque"][0] == pytest.approx(-0.5 * CAPACITY * 100.0**2, rel=1e-14)
    sim = cw.Simulator(_driveline(100.0, lag=0.1))
    sim.advance(0.1)
    # it says how many states there are
    with pytest.raises(cw.ClutchworkError):
        sim.set({"r.lag": 0.0})


def test_its_heat_goes_to_a_node():
    d = cw.Driveline()
    shaft = d.shaft("s", inertia=INERTIA, speed=220.0)
    oil = d.thermal("oil", capacity=5e3, temperature=350.0)
    d.add(cw.Retarder("r", shaft=shaft, capacity=CAPACITY, max_torque=MOST, max_power=POWER, lag=0.3, heat=oil))
    run = d.simulate(5.0, rtol=1e-9, atol=1e-11)
    lost = 0.5 * INERTIA * (220.0**2 - run["s.speed"][-1] ** 2)
    assert run["oil.heat"][-1] == pytest.approx(lost, rel=1e-8)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


@pytest.mark.parametrize(
    "more", [{"command": 5.0}, {"command": cw.Ramp(height=2.0, duration=1.0)}, {"initial_filling": 2.0}], ids=str
)
def test_more_than_full_is_a_mistake(more):
    with pytest.raises(cw.ModelError, match=r"must be >= 0 and <= 1"):
        _driveline(10.0, lag=0.1, **more).assemble()


def _commanded(seed: int) -> str:
    """Whether a retarder that another component commands beyond its bounds drives, or brakes more than a full one."""
    rng = np.random.default_rng([seed, 41])
    lag, swing = float(rng.choice([0.0, rng.uniform(0.01, 0.5)])), float(rng.uniform(1.5, 5.0))
    d = cw.Driveline()
    shaft = d.shaft("s", inertia=INERTIA, speed=float(rng.choice([-1.0, 1.0]) * rng.uniform(50.0, 250.0)))
    wave = cw.Sine(amplitude=swing, frequency=float(rng.uniform(0.5, 3.0)))
    actuator = d.add(cw.RatioActuator("command", command=wave, lag=0.02))
    filling = float(rng.uniform(0.0, 1.0))
    shares = {"lag": lag, "initial_filling": filling}
    d.add(
        cw.Retarder("r", shaft=shaft, capacity=CAPACITY, max_torque=MOST, max_power=POWER, command=actuator, **shares)
    )
    run = simulate(d, 3.0)
    w, torque, most = run["s.speed"], run["r.torque"], _size(run["s.speed"])
    slack = 1e-9 * MOST
    share = np.clip(run["command.ratio"], 0.0, 1.0) if lag == 0.0 else run["r.filling"]
    found = stopped(run)
    found += " drives" if (torque * np.sign(w) > slack).any() else ""
    found += " brakes too much" if (np.abs(torque) > most + slack).any() else ""
    return found + (" does not follow" if (np.abs(-torque * np.sign(w) - share * most) > slack).any() else "")


@pytest.mark.random
def test_a_command_of_another_component_keeps_its_bounds() -> None:
    sweep(_commanded, amount(60))
