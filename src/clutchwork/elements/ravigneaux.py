"""Ravigneaux gear: two suns, one ring, one carrier with long and short planets."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Component, Found, Node, Role, component, param, port
from clutchwork.elements.bases.teeth import ratio_of, ratio_problems


@component(Role.GEAR)
class Ravigneaux(Component):
    """Ravigneaux gear: the large sun meshes the long planets, the small sun the short ones, which mesh the long ones.

    Use it for automatic gearboxes. With the carrier at rest the ring turns against the large sun and with the small
    one: large sun + ratio_large ring = (1 + ratio_large) carrier, and ratio_small ring - small sun = (ratio_small - 1)
    carrier. Give both ratios, teeth of the ring over those of the sun, or all teeth.

    Source: H. L. Benford, M. B. Leising, The lever analogy, SAE Technical Paper 810102, 1981, doi:10.4271/810102.
    """

    small_sun: Node = port("sun of the short planets")
    large_sun: Node = port("sun of the long planets")
    ring: Node = port("ring wheel")
    carrier: Node = port("carrier of all planets")
    ratio_large: float | None = param(
        "1", "teeth of the ring over those of the large sun", default=None, above=1.0, example=2.0
    )
    ratio_small: float | None = param(
        "1", "teeth of the ring over those of the small sun", default=None, above=1.0, example=2.5
    )
    teeth_small_sun: int | None = param("1", "teeth of the small sun", default=None, above=0.0, whole=True)
    teeth_large_sun: int | None = param("1", "teeth of the large sun", default=None, above=0.0, whole=True)
    teeth_ring: int | None = param("1", "teeth of the ring, counted positive", default=None, above=0.0, whole=True)

    def problems(self) -> Found:
        found = ratio_problems(self, "ratio_large", ("teeth_large_sun", "teeth_ring"))
        found += ratio_problems(self, "ratio_small", ("teeth_small_sun", "teeth_ring"))
        if found:
            return found
        large, small = self.exact_ratios()
        if not 1 < large < small:
            name = "ratio_small" if self.ratio_small is not None else "teeth_small_sun"
            message = f"makes the ratios {float(large):g} and {float(small):g}, not 1 < ratio_large < ratio_small"
            return [(name, message, "the ring is the largest wheel, the small sun the smallest")]
        return []

    def exact_ratios(self) -> tuple[Fraction, Fraction]:
        """Ratios of ring to large sun and to small sun as fractions."""
        return (
            ratio_of(self.ratio_large, self.teeth_ring, self.teeth_large_sun),
            ratio_of(self.ratio_small, self.teeth_ring, self.teeth_small_sun),
        )

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        large, small = self.exact_ratios()
        return [
            {"large_sun": Fraction(1), "ring": large, "carrier": -1 - large},
            {"small_sun": Fraction(-1), "ring": small, "carrier": 1 - small},
        ]
