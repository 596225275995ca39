"""Two discs and a clutch, as a function of two of its numbers; and a point at which the clutch does not lock."""

from __future__ import annotations

import numpy as np

import clutchwork as cw

SLOW = np.array([0.2, 1e-6])


def two_discs() -> cw.Differentiable:
    """When the clutch locks, the speed after it and the heat."""
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    pressure = cw.Table([(0.0, 0.0), (0.2, 2e5), (1.0, 2e5)])
    lining = cw.Coulomb(static=0.125, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=5e-4, pressure=pressure))
    return cw.differentiable(d, 2.5, of=[cw.lock("c1"), "load.speed", "c1.heat"], by=["engine.inertia", "c1.gain"])
