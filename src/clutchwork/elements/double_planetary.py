"""Planetary gear with double planets."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Role, component, param
from clutchwork.elements.bases.teeth import PlanetarySet


@component(Role.GEAR)
class DoublePlanetary(PlanetarySet):
    """Planetary gear with pairs of meshing planets: ratio ring - sun = (ratio - 1) carrier.

    Use it for a double-pinion set, where sun and ring turn in the same direction when the carrier is held: one half of
    a Ravigneaux set. Give the ratio teeth_ring/teeth_sun, or both numbers of teeth.
    """

    ratio: float | None = param("1", "teeth of the ring over teeth of the sun", default=None, above=1.0)

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        ratio = self.exact_ratio()
        return [{"sun": Fraction(-1), "ring": ratio, "carrier": 1 - ratio}]
