"""Torque converter and fluid coupling: closed forms, and a launch with lock-up by SciPy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw

RATIO = (0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.97, 1.0)
MULTIPLIED = (2.2, 1.9, 1.6, 1.32, 1.08, 1.0, 1.0, 1.0)
CAPACITY = (2.9e-3, 2.85e-3, 2.75e-3, 2.5e-3, 2.0e-3, 1.5e-3, 0.7e-3, 0.0)
TABLES: dict[str, Any] = {"speed_ratio": RATIO, "torque_ratio": MULTIPLIED, "capacity": CAPACITY}
TIGHT: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-10}


def rig(impeller: float, turbine: float, support: float | None = None, **converter: Any) -> cw.Trajectory:
    """All speeds prescribed."""
    d = cw.Driveline("rig")
    ports = {}
    for port, speed in (("impeller", impeller), ("turbine", turbine), ("support", support)):
        if speed is not None:
            ports[port] = d.shaft(port, inertia=1.0)
            d.add(cw.PrescribedSpeed(f"{port}_speed", shaft=ports[port], speed=speed))
    d.add(cw.TorqueConverter("tc", **ports, **(converter or TABLES)))
    return d.simulate(0.1)


@pytest.mark.parametrize("ratio", [-0.5, 0.0, 0.1, 0.2, 0.75, 0.93, 0.99, 1.0])
@pytest.mark.parametrize("support", [None, 40.0, -30.0])
def test_drive(ratio: float, support: float | None) -> None:
    base, w = support or 0.0, 250.0
    run = rig(base + w, base + ratio * w, support)
    taken = float(np.interp(ratio, RATIO, CAPACITY)) * w * w
    given = float(np.interp(ratio, RATIO, MULTIPLIED)) * taken
    assert run["tc.impeller.torque"][-1] == pytest.approx(-taken, rel=1e-12, abs=1e-12)
    assert run["tc.turbine.torque"][-1] == pytest.approx(given, rel=1e-12, abs=1e-12)
    # heat = T (w_i - m w_t)
    heat = taken * w - given * ratio * w
    assert run.energy.heat["tc"] == pytest.approx(0.1 * heat, rel=1e-9, abs=1e-9)
    if support is not None:
        # the sources of the other two hold what the stator hands on
        assert run["support_speed.torque"][-1] == pytest.approx(given - taken, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("ratio", "factor"), [(0.99, 0.7e-3 / 3), (0.5, 2.625e-3), (0.0, 2.9e-3), (-0.3, 2.9e-3)])
def test_coast(ratio: float, factor: float) -> None:
    run = rig(ratio * 200.0, 200.0)
    torque = factor * 200.0**2
    assert run["tc.impeller.torque"][-1] == pytest.approx(torque, rel=1e-12)
    assert run["tc.turbine.torque"][-1] == pytest.approx(-torque, rel=1e-12)
    assert run.energy.heat["tc"] == pytest.approx(0.1 * torque * (200.0 - ratio * 200.0), rel=1e-9)


def test_coast_has_its_own_capacity() -> None:
    run = rig(100.0, 200.0, **TABLES, coast_capacity=tuple(0.5 * k for k in CAPACITY))
    assert run["tc.impeller.torque"][-1] == pytest.approx(0.5 * 2.625e-3 * 200.0**2, rel=1e-12)


def test_both_backward_has_no_torque_and_a_hint() -> None:
    run = rig(-50.0, -20.0)
    assert not np.any(run["tc.impeller.torque"])
    assert not np.any(run["tc.turbine.torque"])
    assert [hint.rule for hint in run.hints].count("unknown there") == 1


def test_k_factors_are_inverse_roots_of_k_at_the_points() -> None:
    factors = tuple(1.0 / np.sqrt(k) for k in CAPACITY[:-1])
    other = {**TABLES, "capacity": None, "k_factor": factors}
    for ratio in (0.0, 0.3, 0.985):
        one, two = rig(200.0, ratio * 200.0), rig(200.0, ratio * 200.0, **other)
        assert one["tc.turbine.torque"][-1] == pytest.approx(two["tc.turbine.torque"][-1], rel=1e-12)


def test_stall_speed() -> None:
    d = cw.Driveline("stall")
    engine = d.shaft("engine", inertia=0.2, speed=50.0)
    d.add(cw.Torque("drive", shaft=engine, torque=150.0))
    d.add(cw.TorqueConverter("tc", impeller=engine, turbine=d.housing, **TABLES))
    run = d.simulate(5.0, **TIGHT)
    assert run["engine.speed"][-1] == pytest.approx(np.sqrt(150.0 / CAPACITY[0]), rel=1e-9)


def test_lag_is_of_first_order() -> None:
    run = rig(200.0, 0.0, **TABLES, lag=0.05)
    assert run["tc.turbine.torque"][-1] == pytest.approx(
        2.2 * 2.9e-3 * 200.0**2 * (1.0 - np.exp(-0.1 / 0.05)), rel=1e-5
    )
    assert "tc.impeller_torque" in run.units
    assert "tc.impeller_torque" not in rig(200.0, 0.0).units


def test_oil_that_still_coasts_finds_the_stator_free() -> None:
    """A lagged torque of coast goes through whole while the impeller drives; the stator holds from its zero on."""
    lag, first, w = 0.05, -101.0, 200.0
    d = cw.Driveline("late")
    speeds = {"impeller": w, "turbine": 0.4 * w, "support": 0.0}
    ports = {name: d.shaft(name, inertia=1.0) for name in speeds}
    for name, speed in speeds.items():
        d.add(cw.PrescribedSpeed(f"{name}_speed", shaft=ports[name], speed=speed))
    d.add(cw.TorqueConverter("tc", **ports, **TABLES, lag=lag, initial_torque=first))
    run = d.simulate(0.1, **TIGHT)
    last = 2.75e-3 * w * w
    taken = last + (first - last) * np.exp(-run.time / lag)
    turns = lag * np.log1p(-first / last)
    assert np.min(np.abs(run.time - turns)) < 1e-8
    assert run["support_speed.torque"] == pytest.approx(0.6 * np.maximum(taken, 0.0), abs=1e-5)
    assert run["tc.turbine.torque"] == pytest.approx(taken + 0.6 * np.maximum(taken, 0.0), abs=1e-5)


def test_a_stator_that_oil_of_coast_pushed_about() -> None:
    """A torque moves the support away from an impeller at rest: the oil gives it nothing, and it does not chatter."""
    d = cw.Driveline("pushed")
    turbine, support = d.shaft("turbine", inertia=1.0), d.shaft("support", inertia=0.5)
    ports = {"impeller": d.housing, "turbine": turbine, "support": support}
    d.add(cw.Torque("drive", shaft=support, torque=-20.0))
    d.add(cw.TorqueConverter("tc", **ports, **TABLES, lag=1.0, initial_torque=-100.0))
    run = d.simulate(0.05)
    assert run["support.speed"] == pytest.approx(-40.0 * run.time, rel=1e-6, abs=1e-9)


def launch() -> cw.Driveline:
    """An engine, a converter with a lock-up clutch, a car."""
    d = cw.Driveline("launch")
    engine, turbine = d.shaft("engine", inertia=0.25, speed=90.0), d.shaft("turbine", inertia=0.06)
    wheels = d.shaft("wheels", inertia=12.0)
    d.add(cw.Gear("gear", input=turbine, output=wheels, ratio=3.0))
    torque = ((0.0, 100.0), (200.0, 180.0), (400.0, 200.0), (600.0, 120.0))
    d.add(cw.SpeedTorque("drive", shaft=engine, torque=torque))
    d.add(cw.TorqueConverter("tc", impeller=engine, turbine=turbine, **TABLES))
    d.add(cw.QuadraticTorque("road", shaft=wheels, nominal_torque=-300.0, nominal_speed=100.0))
    press = cw.Table([(0.0, 0.0), (2.0, 0.0), (2.5, 2e4)])
    friction = cw.Coulomb(kinetic=0.12, static=0.13)
    d.add(cw.Clutch("lockup", base=engine, follower=turbine, friction=friction, gain=0.1, normal_force=press))
    return d


def slope(t: float, y: np.ndarray) -> list[float]:
    """The same launch up to the lock-up."""
    engine, turbine = y
    taken = float(np.interp(turbine / engine, RATIO, CAPACITY)) * engine**2
    given = float(np.interp(turbine / engine, RATIO, MULTIPLIED)) * taken
    clutch = 0.12 * 0.1 * float(np.interp(t, (0.0, 2.0, 2.5), (0.0, 0.0, 2e4)))
    drive = float(np.interp(engine, (0.0, 200.0, 400.0, 600.0), (100.0, 180.0, 200.0, 120.0)))
    road = 300.0 * (turbine / 3.0 / 100.0) ** 2 / 3.0
    return [(drive - taken - clutch) / 0.25, (given + clutch - road) / (0.06 + 12.0 / 9.0)]


def locked(_: float, y: np.ndarray) -> float:
    """Slip of the converter."""
    return float(y[0] - y[1])


locked.terminal = True  # type: ignore[attr-defined]


def test_a_launch_with_lock_up_agrees_with_scipy() -> None:
    times = np.linspace(0.0, 2.3, 24)
    # short steps over the kinks of the tables
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-12, "max_step": 2e-3}
    found = solve_ivp(slope, (0.0, 3.0), [90.0, 0.0], events=locked, t_eval=times, **options)
    run = launch().simulate(4.0, **TIGHT)
    lock = next(event for event in run.events if event.after == "locked")
    # what the kinks cost SciPy
    assert lock.time == pytest.approx(found.t_events[0][0], abs=1e-9)
    short = launch().simulate(2.3, **TIGHT, times=times)
    assert short["engine.speed"] == pytest.approx(found.y[0], rel=1e-8)
    assert short["turbine.speed"] == pytest.approx(found.y[1], rel=1e-8, abs=1e-8)


def test_locked_the_clutch_carries_all_and_the_converter_nothing() -> None:
    run = launch().simulate(4.0, **TIGHT)
    locked = run.time > 2.5
    assert not np.any(run["tc.impeller.torque"][locked])
    assert not np.any(run["tc.turbine.torque"][locked])
    assert np.all(run["lockup.torque"][locked] > 50.0)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    total = run["tc.impeller.power"] + run["tc.turbine.power"]
    assert run["tc.power"] == pytest.approx(total, rel=1e-12)


def test_through_coast_and_back_the_energy_closes() -> None:
    d = cw.Driveline("overrun")
    engine, turbine = d.shaft("engine", inertia=0.2, speed=300.0), d.shaft("turbine", inertia=1.0, speed=250.0)
    d.add(cw.TorqueConverter("tc", impeller=engine, turbine=turbine, **TABLES))
    d.add(cw.Torque("drive", shaft=engine, torque=cw.Sine(amplitude=150.0, frequency=0.5)))
    run = d.simulate(6.0, **TIGHT)
    slip = run["turbine.speed"] - run["engine.speed"]
    assert np.sum(np.diff(np.sign(slip)) != 0) >= 4
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


@pytest.mark.parametrize(
    ("base", "follower"), [(100.0, 60.0), (60.0, 100.0), (-100.0, -60.0), (100.0, -60.0), (-60.0, 100.0), (80.0, 80.0)]
)
def test_coupling_in_all_quadrants(base: float, follower: float) -> None:
    d = cw.Driveline("coupling")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.PrescribedSpeed("wa", shaft=a, speed=base))
    d.add(cw.PrescribedSpeed("wb", shaft=b, speed=follower))
    number = (0.008, 0.004, 0.0)
    d.add(
        cw.FluidCoupling("c", base=a, follower=b, speed_ratio=(0.0, 0.8, 1.0), performance_number=number, diameter=0.3)
    )
    run = d.simulate(0.1)
    fast, slow = (base, follower) if abs(base) >= abs(follower) else (follower, base)
    k = float(np.interp(slow / fast, (0.0, 0.8, 1.0), number)) * 860.0 * 0.3**5
    sign = 1.0 if fast == base else -1.0
    assert run["c.torque"][-1] == pytest.approx(sign * k * fast * abs(fast), rel=1e-12, abs=1e-15)
    assert run.energy.heat["c"] == pytest.approx(0.1 * k * fast**2 * abs(base - follower), rel=1e-9, abs=1e-12)


def test_a_coupling_that_reverses_within_one_step() -> None:
    """The follower falls below the base and beyond it: both ends of the step are on one piece, not what is between."""
    ratios, capacity = (-0.5, 0.3, 0.8, 1.0), (1.61e-4, 1.45e-4, 8.05e-5, 0.0)
    d = cw.Driveline("reverses")
    a, b = d.shaft("a", inertia=100.0, speed=-1.08), d.shaft("b", inertia=0.00831, speed=16.5)
    d.add(cw.FluidCoupling("c", base=a, follower=b, speed_ratio=ratios, capacity=capacity))
    d.add(cw.Torque("drive", shaft=b, torque=-261.0))
    run = d.simulate(1.0507e-3, first_step=1.05e-3, rtol=1e-3)
    by_base = np.abs(run["a.speed"]) >= np.abs(run["b.speed"])
    fast, slow = (np.where(which, run["a.speed"], run["b.speed"]) for which in (by_base, ~by_base))
    torque = np.interp(slow / fast, ratios, capacity) * fast * np.abs(fast) * np.where(by_base, 1.0, -1.0)
    # round-off of speeds of 20 rad/s at a slope of 1e-2 N m s/rad
    np.testing.assert_allclose(run["c.torque"], torque, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("lag", [0.0, 1e-4])
def test_a_turbine_that_turns_around_beside_a_standing_impeller(lag: float) -> None:
    """It turns back free, and is braked by the square of its speed from rest on: there is no ratio of speeds there."""
    inertia, torque, back = 0.01, 50.0, 20.0
    d = cw.Driveline("standing")
    shaft = d.shaft("s", inertia=inertia, speed=-back)
    d.add(cw.Torque("drive", shaft=shaft, torque=torque))
    d.add(cw.TorqueConverter("tc", impeller=d.housing, turbine=shaft, lag=lag, **TABLES))
    rest, top = inertia * back / torque, (torque / CAPACITY[0]) ** 0.5
    end = rest + 0.02
    run = d.simulate(end, times=[rest / 2, end], **TIGHT)
    speeds = [-back / 2, top * np.tanh(0.02 * torque / (inertia * top))]
    # a lag shifts the speed by about as long
    assert run["s.speed"] == pytest.approx(speeds, rel=1e-9 if lag == 0.0 else 0.02)


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"capacity": None}, "k_factor"),
        ({"k_factor": (10.0,) * 7}, "beside"),
        ({"capacity": (*CAPACITY[:-1], 1e-4)}, "jump"),
        ({"torque_ratio": (2.0, 1.0)}, "speed ratios"),
        ({"speed_ratio": (*RATIO[:-1], 0.99)}, "end at 1"),
        ({"torque_ratio": (*MULTIPLIED[:-1], 1.2)}, "1.2 at speed ratio 1, above 1: it would give power"),
    ],
)
def test_tables_that_do_not_fit_are_refused(changes: dict[str, Any], word: str) -> None:
    with pytest.raises(cw.ModelError, match=word):
        rig(1.0, 1.0, **{**TABLES, **changes})


@pytest.mark.parametrize("torques", [(1.0, 0.9), (0.9, 1.0), (0.3, 1.0)])
def test_a_coupling_with_a_fine_table_leaves_rest(torques: tuple[float, float]) -> None:
    """At once at the ratio of the torques, past most points of its table."""
    ratios = np.linspace(0.0, 1.0, 101)
    d = cw.Driveline("from rest")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.FluidCoupling("c", base=a, follower=b, speed_ratio=ratios, capacity=5e-3 * (1.0 - ratios)))
    for shaft, torque in zip((a, b), torques, strict=True):
        d.add(cw.Torque(f"on {shaft.name}", shaft=shaft, torque=torque))
    run = d.simulate(1.0)
    assert run["a.speed"][-1] + run["b.speed"][-1] == pytest.approx(sum(torques), rel=1e-6)
