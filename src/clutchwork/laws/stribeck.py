"""Coefficient that falls along a Stribeck curve, with exact sticking."""

from __future__ import annotations

from clutchwork.declare import Role, component
from clutchwork.laws.bases.stribeck import StribeckCurve


@component(Role.LAW, hooks=("edges", "edge"))
class Stribeck(StribeckCurve):
    """Kinetic coefficient `s(slip) + viscous slip`, static coefficient at rest; it sticks exactly.

    Use it for lubricated clutches, brakes and bearings, and wherever the falling coefficient excites judder or
    stick-slip. It has no deflection before break-away.

    Source: B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit 1994, doi:10.1016/0005-1098(94)90209-7.
    """

    def sliding(self) -> float:
        return self.static
