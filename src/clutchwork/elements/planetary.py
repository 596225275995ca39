"""Planetary gear with single planets."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Component, Node, Role, component, exact, param, port


@component(Role.GEAR)
class Planetary(Component):
    """Planetary gear: sun + ratio ring = (1 + ratio) carrier.

    Use it for a simple planetary set, where sun and ring turn opposite ways when the carrier stands. Give the ratio
    teeth_ring/teeth_sun, or both numbers of teeth.
    """

    sun: Node = port("sun wheel")
    ring: Node = port("ring wheel")
    carrier: Node = port("carrier of the planets")
    ratio: float | None = param("1", "teeth of the ring over teeth of the sun", default=None, above=0.0)
    teeth_sun: int | None = param("1", "teeth of the sun", default=None, above=0.0, whole=True)
    teeth_ring: int | None = param("1", "teeth of the ring, counted positive", default=None, above=0.0, whole=True)

    def problems(self) -> list[tuple[str, str, str]]:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        sun, ring = self.teeth_sun, self.teeth_ring
        if self.ratio is None and (sun is None or ring is None):
            return [("ratio", "is missing", "give `ratio`, or both `teeth_sun` and `teeth_ring`")]
        if self.ratio is not None and (sun, ring) != (None, None):
            return [("ratio", "is given twice, as a number and by teeth", "give only one of the two")]
        if sun is not None and ring is not None and ring <= sun:
            return [("teeth_ring", f"is {ring:g}, not above teeth_sun = {sun:g}", "a ring has more teeth than its sun")]
        return []

    def exact_ratio(self) -> Fraction:
        """Ratio as a fraction."""
        if self.ratio is not None:
            return exact(self.ratio)
        return exact(self.teeth_ring or 0) / exact(self.teeth_sun or 1)

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        ratio = self.exact_ratio()
        return [{"sun": Fraction(1), "ring": ratio, "carrier": -1 - ratio}]
