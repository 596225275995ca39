"""Limits of a clutch that pass zero: it opens and closes whether or not a phase begins where it is open.

A torque of zero with knots makes phases begin anywhere; nothing else may follow from it. What it holds is within
its limits, which are signals.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount
from support.sweep import simulate, stopped, sweep

T_END = 1.0
GRID = np.linspace(0.0, T_END, 101)


def limit(rng: np.random.Generator, sign: float) -> Any:
    """A limit of a sign that is on its other side for a while, or never there."""
    if rng.random() < 0.25:
        return 0.0
    size = sign * float(rng.uniform(2.0, 20.0))
    wave = {"frequency": float(rng.uniform(0.5, 3.0)), "phase": float(rng.uniform(0.0, 6.0))}
    return cw.Sine(amplitude=size, offset=size * float(rng.uniform(-0.6, 0.6)), **wave)


def driveline(seed: int, knots: bool) -> cw.Driveline:
    """Two shafts on a spring, driven back and forth, with a clutch that may only hold between them."""
    rng = np.random.default_rng([seed, 12])
    d = cw.Driveline(f"limits {seed}")
    a, b = d.shaft("a", inertia=0.1, speed=float(rng.normal(0.0, 5.0))), d.shaft("b", inertia=0.2)
    kinetic = 0.0 if rng.random() < 0.6 else limit(rng, 1.0)
    limits = {"kinetic": kinetic, "upper": limit(rng, 1.0), "lower": limit(rng, -1.0)}
    d.add(cw.FundamentalClutch("clutch", base=a, follower=b, **limits))
    d.add(cw.SpringDamper("spring", base=a, follower=b, stiffness=100.0, damping=0.1))
    push = cw.Sine(amplitude=float(rng.uniform(2.0, 20.0)), frequency=float(rng.uniform(1.0, 4.0)))
    d.add(cw.Torque("push", shaft=a, torque=push))
    times = np.sort(rng.uniform(0.0, T_END, 6))
    if knots:
        d.add(cw.Torque("nothing", shaft=b, torque=cw.Table([(float(t), 0.0) for t in times])))
    return d


def differs(seed: int) -> str:
    """How far the same motion with knots of nothing is from that without."""
    plain, cut = (simulate(driveline(seed, knots), T_END, rtol=1e-9, atol=1e-11, times=GRID) for knots in (False, True))
    if text := stopped(plain) or stopped(cut):
        return text
    size = float(np.abs(plain["b.speed"]).max()) + 1.0
    error = float(np.abs(plain["b.speed"] - cut["b.speed"]).max()) / size
    return "" if error < 1e-5 else f"b.speed differs by {error:.1e} of full scale"


@pytest.mark.random
def test_knots_of_nothing_change_nothing() -> None:
    sweep(differs, amount(100))


def test_the_clutches_open_and_lock() -> None:
    """Enough happens: many are open for a while and lock later."""
    runs = [simulate(driveline(seed, True), T_END) for seed in range(40)]
    opened = [run for run in runs if "open" in run["clutch.state"]]
    assert len(opened) >= 10
    assert sum("locked" in {event.after for event in run.events} for run in opened) >= 5
