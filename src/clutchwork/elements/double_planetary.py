"""Planetary gear with double planets."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Component, Found, Node, Role, component, param, port
from clutchwork.elements.bases.teeth import ratio_of, ring_problems


@component(Role.GEAR)
class DoublePlanetary(Component):
    """Planetary gear with pairs of meshing planets: ratio ring - sun = (ratio - 1) carrier.

    Use it for a double-pinion set, where sun and ring turn the same way when the carrier stands: one half of a
    Ravigneaux set. Give the ratio teeth_ring/teeth_sun, or both numbers of teeth.
    """

    sun: Node = port("sun wheel")
    ring: Node = port("ring wheel")
    carrier: Node = port("carrier of the planets")
    ratio: float | None = param("1", "teeth of the ring over teeth of the sun", default=None, above=1.0)
    teeth_sun: int | None = param("1", "teeth of the sun", default=None, above=0.0, whole=True)
    teeth_ring: int | None = param("1", "teeth of the ring, counted positive", default=None, above=0.0, whole=True)

    def problems(self) -> Found:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        return ring_problems(self)

    def exact_ratio(self) -> Fraction:
        """Ratio as a fraction."""
        return ratio_of(self.ratio, self.teeth_ring, self.teeth_sun)

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        ratio = self.exact_ratio()
        return [{"sun": Fraction(-1), "ring": ratio, "carrier": 1 - ratio}]
