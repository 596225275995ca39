"""The smallest thing to calibrate: two discs, a clutch with a constant torque, everything in closed form."""

from __future__ import annotations

from typing import Any

import clutchwork as cw

ENGINE, LOAD, SPEED, GAIN, LINING, PRESSURE = 0.2, 0.8, 100.0, 5e-4, 0.1, 2e5
# of both discs towards each other
BOTH = ENGINE * LOAD / (ENGINE + LOAD)


def discs() -> cw.Driveline:
    """Locks after SPEED * BOTH / (GAIN * LINING * PRESSURE)."""
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=ENGINE, speed=SPEED), d.shaft("load", inertia=LOAD)
    pressure = cw.Table([(0.0, PRESSURE), (1.0, PRESSURE), (5.0, PRESSURE)])
    lining = cw.Coulomb(static=1.2 * LINING, kinetic=LINING)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=GAIN, pressure=pressure))
    return d


def least_torque(latest: float = 1.0, model: Any = None, **how: Any) -> cw.Calibration:
    """The least torque with which they lock in time: SPEED * BOTH / latest."""
    return cw.calibrate(
        model or discs(),
        5.0,
        free={"pressure": cw.together("c1.pressure.values", factor=(0.3, 3.0))},
        minimise=cw.at("c1.torque", 0.1),
        subject_to=[cw.limit(cw.lock("c1"), upper=latest)],
        **how,
    )
