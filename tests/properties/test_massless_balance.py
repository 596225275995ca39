"""Shafts without inertia: torques balance in every row, from the first one on, on any pieces; accelerations follow."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import clutchwork as cw
from support.amount import amount
from support.sweep import log_uniform, simulate, stopped, sweep

Rng = np.random.Generator


def _jumping(rng: Rng, size: float) -> cw.Table:
    """A value that jumps, bends and jumps back."""
    times = np.sort(rng.uniform(0.02, 0.25, 3))
    first, second, third = (float(x) for x in size * rng.uniform(0.2, 3.0, 3))
    return cw.Table(
        [(0.0, first), (times[0], first), (times[0], second), (times[1], third), (times[2], third), (times[2], first)]
    )


def _load(d: cw.Driveline, rng: Rng, shaft: Any) -> Any:
    """A load over the speed that falls nowhere faster than its damper rises."""
    size, speed = log_uniform(rng, 1.0, 100.0), log_uniform(rng, 1.0, 200.0)
    kind = rng.integers(6)
    if kind == 0:
        count = int(rng.integers(3, 8))
        x = np.sort(rng.uniform(-300.0, 300.0, count))
        y = np.sort(rng.uniform(-size, size, count))[::-1]
        return d.add(cw.SpeedTorque("t", shaft=shaft, torque=list(zip(map(float, x), map(float, y), strict=True))))
    if kind == 1:
        even = bool(rng.random() < 0.5)
        return d.add(cw.LinearTorque("t", shaft=shaft, nominal_torque=-size, nominal_speed=speed, same_direction=even))
    if kind == 2:
        return d.add(cw.QuadraticTorque("t", shaft=shaft, nominal_torque=-size, nominal_speed=speed))
    if kind == 3:
        return d.add(
            cw.ResistingTorque("t", shaft=shaft, torque=_jumping(rng, size), speed=log_uniform(rng, 0.1, 10.0))
        )
    if kind == 4:
        return d.add(cw.Torque("t", shaft=shaft, torque=_jumping(rng, size)))
    return d.add(cw.EddyCurrentBrake("t", shaft=shaft, nominal_torque=size, nominal_speed=speed))


def _driven(seed: int) -> tuple[cw.Driveline, Any, float]:
    rng = np.random.default_rng([seed, 61])
    d = cw.Driveline("massless")
    b = d.shaft("b", inertia=log_uniform(rng, 0.1, 3.0), speed=float(rng.uniform(-200.0, 200.0)))
    a = d.shaft("a", inertia=0.0)
    load = _load(d, rng, a)
    # steep enough for one balance: a falling part of a load is at most 3 N m s/rad steep
    damping = log_uniform(rng, 0.05, 5.0) if not isinstance(load, cw.EddyCurrentBrake | cw.LinearTorque) else 300.0
    if rng.random() < 0.5:
        d.add(cw.Damper("k", base=a, follower=b, damping=damping))
    else:
        d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=log_uniform(rng, 1.0, 300.0), damping=damping))
    return d, load, damping


def balance(seed: int) -> str:
    """The torques on the shaft balance in all rows, and its acceleration is that of the balance."""
    d, _, damping = _driven(seed)
    run = simulate(d, 0.3, output="steps", rtol=1e-8, atol=1e-10)
    if text := stopped(run):
        return text
    torque, load, speed = run["k.torque"], run["t.torque"], run["a.speed"]
    size = np.abs(torque) + np.abs(load) + damping * np.abs(speed)
    off = np.abs(load - torque) / (1e-3 + size.max())
    return f"off by {off.max():.2g} at {run.time[off.argmax()]:.4g} s" if off.max() > 1e-6 else ""


def _root(torque: Any, low: float, high: float) -> float:
    return float(brentq(torque, low, high, xtol=1e-13, rtol=1e-15))


def start(seed: int) -> str:
    """A table over the speed: the start is the one root of its balance, wherever that lies."""
    rng = np.random.default_rng([seed, 62])
    count, damping = int(rng.integers(3, 9)), log_uniform(rng, 0.01, 10.0)
    x, y = np.sort(rng.uniform(-300.0, 300.0, count)), np.sort(rng.uniform(-50.0, 50.0, count))[::-1]
    d = cw.Driveline("start")
    speed = float(rng.uniform(-500.0, 500.0))
    b, a = d.shaft("b", inertia=1.0, speed=speed), d.shaft("a", inertia=0.0)
    d.add(cw.Damper("d", base=a, follower=b, damping=damping))
    d.add(cw.SpeedTorque("t", shaft=a, torque=list(zip(map(float, x), map(float, y), strict=True))))
    run = simulate(d, 0.01, output="steps", rtol=1e-8, atol=1e-10)

    def torque(w: float) -> float:
        k = int(np.clip(np.searchsorted(x, w) - 1, 0, count - 2))
        return float(y[k] + (y[k + 1] - y[k]) * (w - x[k]) / (x[k + 1] - x[k]))

    def slope(w: float) -> float:
        k = int(np.clip(np.searchsorted(x, w) - 1, 0, count - 2))
        return float((y[k + 1] - y[k]) / (x[k + 1] - x[k]))

    known = _root(lambda w: torque(w) + damping * (speed - w), -1e6, 1e6)
    found, rate, pulled = (float(run[f"{name}"][0]) for name in ("a.speed", "a.acceleration", "b.acceleration"))
    if abs(found - known) > 1e-7 * (1 + abs(known)):
        return f"starts at {found}, balance at {known}"
    expected = pulled * damping / (damping - slope(known))
    close = min(abs(known - x)) > 1e-6
    return (
        f"acceleration {rate}, of the balance {expected}"
        if close and abs(rate - expected) > 1e-5 * abs(expected)
        else ""
    )


def held(seed: int) -> str:
    """A brake on the other side of the damper is decided with the torque of the balance: no row is beyond it."""
    rng = np.random.default_rng([seed, 63])
    pull, holds = log_uniform(rng, 1.0, 100.0), log_uniform(rng, 1.0, 100.0)
    d = cw.Driveline("held")
    b, a = d.shaft("b", inertia=1.0), d.shaft("a", inertia=0.0)
    d.add(cw.Damper("d", base=a, follower=b, damping=log_uniform(rng, 0.01, 1.0)))
    d.add(cw.Torque("t", shaft=a, torque=pull))
    friction = cw.Coulomb(static=1.2, kinetic=1.0)
    d.add(cw.Brake("brake", shaft=b, friction=friction, gain=1.0, normal_force=holds))
    run = simulate(d, 0.2, output="steps")
    if text := stopped(run):
        return text
    most, moves = float(np.abs(run["brake.torque"]).max()), bool(abs(run["b.speed"][-1]) > 1e-9)
    if most > 1.2 * holds * (1 + 1e-9) or (moves and most > max(holds, 1e-9) * (1 + 1e-9)):
        return f"holds {most:.6g} N m with {holds:.6g}, {'moving' if moves else 'at rest'}"
    return "" if moves == (pull > 1.2 * holds) else f"pull {pull:.4g}, capacity {1.2 * holds:.4g}, moves: {moves}"


@pytest.mark.random
@pytest.mark.parametrize("check", [balance, start, held])
def test_speeds_without_inertia_keep_their_balance(check: Any) -> None:
    sweep(check, amount())


def test_a_retarder_on_a_shaft_without_inertia_starts_on_its_branch_of_power() -> None:
    """100 W / w = 0.05 (200 - w): w = 100 + sqrt(8000)."""
    d = cw.Driveline("retarder")
    b, a = d.shaft("b", inertia=1.0, speed=200.0), d.shaft("a", inertia=0.0)
    d.add(cw.Damper("d", base=a, follower=b, damping=0.05))
    d.add(cw.Retarder("t", shaft=a, capacity=1e-4, max_torque=2.0, max_power=100.0))
    run = d.simulate(0.5)
    assert run["a.speed"][0] == pytest.approx(100.0 + 8000.0**0.5, rel=1e-9)


def _continued(seed: int) -> str:
    """A run that goes on from each of its steps does what the whole run does, to the last bit."""
    d, _, _ = _driven(seed)
    whole = simulate(d, 0.1, output="steps")
    for at in np.unique(whole.time)[1:-1:7]:
        rest = simulate(d, 0.1, start=whole.state(at=float(at)), output="steps")
        if (rest.rows[-1] != whole.rows[-1]).any():
            return f"at {float(at)!r} s"
    return ""


@pytest.mark.random
def test_runs_go_on_from_their_steps() -> None:
    """The balance was found where the phase began: a step behind it is not one of Newton's."""
    sweep(_continued, amount(60))


def test_rows_inside_of_steps_balance() -> None:
    """A torque on a damper, w = T/c: rows between the ends of steps have it as exactly as those at the ends."""
    damping, torque = 2.0, cw.Sine(amplitude=35.0, frequency=60.0)
    d = cw.Driveline("inside")
    a = d.shaft("a", inertia=0.0)
    d.add(cw.Torque("drive", shaft=a, torque=torque))
    d.add(cw.Damper("k", base=d.housing, follower=a, damping=damping))
    run = simulate(d, 0.05)
    wanted = 35.0 / damping * np.sin(2.0 * np.pi * 60.0 * run.time)
    assert np.abs(run["a.speed"] - wanted).max() <= 1e-8 * 35.0 / damping


def test_torques_that_fade_to_round_off_balance_in_every_row() -> None:
    """A spring that relaxes through a damper: what is missing is compared with itself, not with a torque of 1e-16."""
    d = cw.Driveline("fades")
    a, b = d.shaft("a", speed=64.8), d.shaft("b")
    d.shaft("beside", inertia=0.1, speed=4.68)
    d.add(cw.Damper("damper", base=a, follower=b, damping=1.3))
    d.add(cw.Spring("spring", base=a, follower=b, stiffness=2550.0, initial_twist=0.0164))
    points = [(0.01139, 0.05774), (0.01661, 0.0), (0.04617, 0.0), (0.05486, 0.1185)]
    d.add(cw.PrescribedPosition("motion", shaft=a, position=cw.Table(points), cutoff=3.3))
    run = d.simulate(0.0626)
    # a billionth of both torques at each instant, or round-off of a speed of 60 rad/s times the damping
    allowed = 2e-9 * np.abs(run["spring.torque"]) + 1e-13
    assert np.all(np.abs(run["damper.torque"] + run["spring.torque"]) < allowed)
