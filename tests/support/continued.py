"""Runs that are continued, and a driveline for them."""

from __future__ import annotations

import clutchwork as cw


def same(one: cw.Trajectory, other: cw.Trajectory) -> None:
    """Bit for bit, where both are."""
    assert one.time.tobytes() == other.time.tobytes()
    assert one.rows.tobytes() == other.rows.tobytes()
    assert one.events == other.events


def brake(inertia: float = 1.0) -> cw.Driveline:
    """A shaft beside a brake whose pressure jumps."""
    d = cw.Driveline("brake")
    a = d.shaft("a", inertia=inertia, speed=100.0)
    table = cw.Table([(0.0, 0.0), (0.2, 1e5), (0.6, 1e5), (0.6, 2e5), (0.8, 2e5)])
    friction = cw.Coulomb(static=0.3, kinetic=0.25)
    d.add(cw.Brake("b", shaft=a, friction=friction, gain=1e-3, pressure=table))
    return d
