"""Stribeck friction with a band of slip in which it sticks."""

from __future__ import annotations

from clutchwork.declare import Role, component, param
from clutchwork.laws.bases.stribeck import StribeckCurve


@component(Role.LAW, hooks=("edges", "edge"))
class Karnopp(StribeckCurve):
    """As `Stribeck` outside a band of slip; inside it counts as stuck and locks.

    Use it to compare with simulations that were made with this classical law. `Stribeck` has no band to choose and
    loses no momentum.

    Source: D. Karnopp 1985, doi:10.1115/1.3140698.
    """

    band: float = param("rad/s", "abs(slip) below which it sticks", above=0.0, units=("m/s",), example=0.01)

    def sliding(self) -> float:
        return self.static
