"""Disc clutches between two shafts, and what their tests measure on them."""

from __future__ import annotations

from typing import Any

import clutchwork as cw

J1, J2, W0 = 0.2, 0.8, 100.0
REDUCED = J1 * J2 / (J1 + J2)
LINING = cw.Coulomb(static=0.35, kinetic=0.3)
# torque over pressure and coefficient of what `clutch` makes by default [m3]
GAIN = 4 * 0.13 * 1e-3


def clutch(name: str = "c1", **given: Any) -> Any:
    """Base and follower are added by `discs`; it locks at zero slip exactly."""
    return name, {"friction": LINING, "radius": 0.13, "area": 1e-3, "pressure": 2e5, "tolerance": 0.0, **given}


def discs(made: Any, speed: float = W0, torque: float = 0.0) -> cw.Driveline:
    """Two discs, the follower with the speed, and a torque on the base."""
    name, given = made
    d = cw.Driveline("discs")
    base, follower = d.shaft("base", inertia=J2), d.shaft("follower", inertia=J1, speed=speed)
    if torque:
        d.add(cw.Torque("load", shaft=base, torque=torque))
    d.add(cw.DiskClutch(name, base=base, follower=follower, **given))
    return d


def rising(slope: float) -> cw.Table:
    """A signal that rises from zero."""
    return cw.Table([(0.0, 0.0), (10.0, 10.0 * slope)])


def problems(**given: Any) -> list[str]:
    """Mistakes of a disc clutch, in words."""
    return [str(problem) for problem in discs(clutch(**given)).check()]


def ports() -> dict[str, cw.Node]:
    """Two shafts of no driveline."""
    return {"base": cw.Node("base", inertia=1.0), "follower": cw.Node("follower", inertia=1.0)}


def coefficient(law: cw.Law, slip: float) -> float:
    """Kinetic coefficient at a slip [rad/s], from a clutch under prescribed speed."""
    d = cw.Driveline("law")
    shaft = d.shaft("a", inertia=1.0)
    d.add(cw.PrescribedSpeed("p", shaft=shaft, speed=slip))
    d.add(cw.DiskClutch("c", base=d.housing, follower=shaft, friction=law, radius=1.0, surfaces=1, normal_force=1.0))
    return float(-d.simulate(1e-3)["c.torque"][0])


# a coefficient over temperature and speed
MAP: dict[str, Any] = {
    "temperatures": [300.0, 400.0],
    "speeds": [0.0, 100.0],
    "static": [0.4, 0.3],
    "kinetic": [[0.35, 0.25], [0.28, 0.16]],
}
