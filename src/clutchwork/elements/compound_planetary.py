"""Planetary gear with stepped planets."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Component, Found, Node, Role, component, exact, param, port
from clutchwork.elements.bases.teeth import ratio_problems

TEETH = ("teeth_sun", "teeth_planet_sun", "teeth_planet_ring", "teeth_ring")


@component(Role.GEAR)
class CompoundPlanetary(Component):
    """Planetary gear with stepped planets, two wheels on one pin: sun + ratio ring = (1 + ratio) carrier.

    Use it where a single set cannot have the ratio: one wheel of each planet meshes the sun, the other one the ring, so
    ratio = (teeth_planet_sun/teeth_sun) (teeth_ring/teeth_planet_ring). Sets with two suns or two rings are pairs of a
    `Gear` whose support is the carrier, with the planets as a shaft between them.
    """

    sun: Node = port("sun wheel")
    ring: Node = port("ring wheel")
    carrier: Node = port("carrier of the planets")
    ratio: float | None = param("1", "ring to sun with the carrier at rest", default=None, above=0.0)
    teeth_sun: int | None = param("1", "teeth of the sun", default=None, above=0.0, whole=True)
    teeth_planet_sun: int | None = param(
        "1", "teeth of the wheel of a planet at the sun", default=None, above=0.0, whole=True
    )
    teeth_planet_ring: int | None = param(
        "1", "teeth of the wheel of a planet at the ring", default=None, above=0.0, whole=True
    )
    teeth_ring: int | None = param("1", "teeth of the ring, counted positive", default=None, above=0.0, whole=True)

    def problems(self) -> Found:
        found = ratio_problems(self, "ratio", TEETH)
        planet, ring = self.teeth_planet_ring, self.teeth_ring
        if not found and planet is not None and ring is not None and ring <= planet:
            message = f"is {ring:g}, not above teeth_planet_ring = {planet:g}"
            return [("teeth_ring", message, "a ring has more teeth than the planets in it")]
        return found

    def exact_ratio(self) -> Fraction:
        """Ratio as a fraction."""
        if self.ratio is not None:
            return exact(self.ratio)
        sun, at_sun, at_ring, ring = (exact(getattr(self, name) or 1) for name in TEETH)
        return at_sun * ring / (sun * at_ring)

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        ratio = self.exact_ratio()
        return [{"sun": Fraction(1), "ring": ratio, "carrier": -1 - ratio}]
