"""Runs that the pictures are of."""

from __future__ import annotations

import sys
import warnings
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

import clutchwork as cw

pytest.importorskip("matplotlib").use("agg")

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
FILES = sorted(EXAMPLES.glob("*/model.toml"))
LINING = cw.Coulomb(static=0.125, kinetic=0.1)


@cache
def example(name: str) -> cw.Trajectory:
    """A run of an example: of its model file, or of its program where it has none."""
    if name != "hill_starts":
        return cw.Driveline.load(EXAMPLES / name / "model.toml").simulate()
    sys.path[:0] = [str(EXAMPLES / folder) for folder in ("car_launch", "hill_starts")]
    script = import_module("hill_starts")
    with warnings.catch_warnings():
        # the clutch gets too hot, which is the point of it
        warnings.simplefilter("ignore", script.ClutchTooHotWarning)
        return script.starts(script.Driver())


NAMES = [*(path.parent.name for path in FILES), "hill_starts"]


def two_discs(name: str = "c1", gain: float = 5e-4, engine: str = "engine") -> cw.Driveline:
    """The model of the README."""
    d = cw.Driveline(f"two discs, {name}")
    turning, load = d.shaft(engine, inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    pressure = cw.Table([(0.0, 0.0), (0.2, 2e5)])
    d.add(cw.Clutch(name, base=turning, follower=load, friction=LINING, gain=gain, pressure=pressure))
    return d


@pytest.fixture(scope="session")
def discs() -> cw.Trajectory:
    """Two discs that a clutch joins at 1.7 s."""
    return two_discs().simulate(2.5)


@pytest.fixture(scope="session")
def six_speed() -> cw.Trajectory:
    """The launch and shift of the gearbox."""
    return example("six_speed")


def chain(count: int) -> cw.Trajectory:
    """A chain of shafts with a clutch between every two."""
    d = cw.Driveline("chain")
    before = d.shaft("shaft 0", inertia=1.0, speed=100.0)
    for i in range(1, count + 1):
        after = d.shaft(f"shaft {i}", inertia=0.1)
        rise = cw.Ramp(height=3e5, duration=1.0, start=0.02 * i)
        d.add(cw.Clutch(f"clutch {i}", base=before, follower=after, friction=LINING, gain=1e-3, pressure=rise))
        before = after
    return d.simulate(2.0)
