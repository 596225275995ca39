"""Two discs whose clutch scatters: a run takes some ten microseconds, and the numbers follow from a formula."""

from __future__ import annotations

from typing import Any

import clutchwork as cw

T_END = 3.0  # s
OUTPUTS: tuple[Any, ...] = ("load.speed", cw.lock("c1"), "c1.heat")
VARY = {"c1.gain": cw.uniform(4e-4, 8e-4), "c1.pressure": cw.normal(2e5, 1e4)}


def discs() -> cw.System:
    """A disc of 0.2 kg m2 at 100 rad/s, joined to one of 0.8 kg m2 at rest."""
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    lining = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=5e-4, pressure=2e5))
    return d.assemble()


def design(count: int, **how: Any) -> cw.Design:
    """Gain and pressure."""
    return cw.design(VARY, count, **how)
