"""Two discs that lock and break away again, measured with noise."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import clutchwork as cw
from clutchwork.fit import Record

TIMES = np.linspace(0.0, 2.5, 126)
SPEEDS = ("engine.speed", "load.speed")
RISE, PRESSURE = 0.2, 4e5
TRUE = {"c1.friction.kinetic": 0.1, "c1.friction.static": 0.13, "engine.inertia": 0.2, "load.inertia": 0.8}
GUESS = {"c1.friction.kinetic": 0.08, "c1.friction.static": 0.15, "engine.inertia": 0.25, "load.inertia": 0.7}


def discs(speed: float = 100.0, pressure: float = PRESSURE, gain: float = 5e-4) -> cw.Driveline:
    """Lock before 1.4 s; the drive then pulls them apart. The true values are in `TRUE`."""
    d = cw.Driveline("two discs")
    engine = d.shaft("engine", inertia=TRUE["engine.inertia"], speed=speed)
    load = d.shaft("load", inertia=TRUE["load.inertia"], speed=0.0)
    lining = cw.Coulomb(static=TRUE["c1.friction.static"], kinetic=TRUE["c1.friction.kinetic"])
    applied = cw.Table([(0.0, 0.0), (RISE, pressure), (2.5, pressure)])
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=gain, pressure=applied))
    drive = cw.Table([(0.0, 0.0), (1.4, 0.0), (1.8, 60.0), (2.5, 60.0)])
    d.add(cw.Torque("drive", shaft=engine, torque=drive))
    return d


def guess(**given: float) -> cw.System:
    """The same with other values to start from."""
    return discs(**given).assemble().changed(GUESS)


def samples(model: cw.Driveline, noise: float, seed: int, alike: float = 0.0) -> dict[str, NDArray[np.float64]]:
    """Speeds with noise [rad/s].

    Parameters: alike, correlation of neighbours of the noise.
    """
    run = model.simulate(TIMES[-1], times=TIMES, rtol=1e-9, atol=1e-11)
    rng = np.random.default_rng(seed)
    return {name: run[name] + noise * coloured(rng.normal(size=len(TIMES)), alike) for name in SPEEDS}


def coloured(white: NDArray[np.float64], alike: float) -> NDArray[np.float64]:
    """Noise of the same size whose neighbours are alike."""
    found = white.copy()
    for place in range(1, len(white)):
        found[place] = alike * found[place - 1] + np.sqrt(1.0 - alike**2) * white[place]
    return found


def record(noise: float = 0.3, seed: int = 1, signals: Sequence[str] = SPEEDS, **given: Any) -> Record:
    """A record of two discs."""
    known = samples(discs(**given), noise, seed)
    return Record(TIMES, {name: known[name] for name in signals})
