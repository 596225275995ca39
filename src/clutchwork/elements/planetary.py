"""Planetary gear with single planets."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Role, component
from clutchwork.elements.bases.teeth import PlanetarySet


@component(Role.GEAR)
class Planetary(PlanetarySet):
    """Planetary gear: sun + ratio ring = (1 + ratio) carrier.

    Use it for a simple planetary set, where sun and ring turn in opposite directions when the carrier is held. Give the
    ratio teeth_ring/teeth_sun, or both numbers of teeth.
    """

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        ratio = self.exact_ratio()
        return [{"sun": Fraction(1), "ring": ratio, "carrier": -1 - ratio}]
