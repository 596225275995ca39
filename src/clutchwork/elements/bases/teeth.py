"""Ratios that are given as a number or by numbers of teeth, and the gears that have one."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from clutchwork.declare import Component, Found, Node, exact, family, param, port


def ratio_problems(gear: Any, name: str, teeth: Sequence[str]) -> Found:
    """A ratio that is given twice, or not at all."""
    given = [getattr(gear, tooth) for tooth in teeth]
    named = " and ".join(f"`{tooth}`" for tooth in teeth)
    if getattr(gear, name) is None and None in given:
        return [(name, "is missing", f"give `{name}`, or {named}")]
    if getattr(gear, name) is not None and any(tooth is not None for tooth in given):
        return [(name, "is given twice, as a number and by teeth", "give only one of the two")]
    return []


def ratio_of(number: float | None, over: float | None, under: float | None) -> Fraction:
    """A ratio as a fraction: the number, else that of the teeth."""
    return exact(number) if number is not None else exact(over or 0) / exact(under or 1)


@family
class WheelPair(Component):
    """Two wheels: ratio = speed of the input over speed of the output, both relative to the support."""

    input: Node = port("shaft whose speed is ratio times that of the output")
    output: Node = port("other shaft")
    support: Node | None = port("member that carries the gear and takes the reaction", default=None)
    ratio: float | None = param("1", "speed of the input over speed of the output", default=None)
    teeth_input: int | None = param("1", "teeth of the input wheel, negative if internal", default=None, whole=True)
    teeth_output: int | None = param("1", "teeth of the output wheel, negative if internal", default=None, whole=True)

    def problems(self) -> Found:
        teeth = ("teeth_input", "teeth_output")
        zero = [name for name in ("ratio", *teeth) if getattr(self, name) == 0]
        remedy = "give a number other than zero; a fixed shaft is the housing"
        return ratio_problems(self, "ratio", teeth) or [(name, "is zero", remedy) for name in zero]

    def exact_ratio(self) -> Fraction:
        """Ratio as a fraction; wheels of an external pair turn opposite ways."""
        return exact(self.ratio) if self.ratio is not None else -ratio_of(None, self.teeth_output, self.teeth_input)


@family
class PlanetarySet(Component):
    """A sun, a ring and the carrier of the planets between them."""

    sun: Node = port("sun wheel")
    ring: Node = port("ring wheel")
    carrier: Node = port("carrier of the planets")
    ratio: float | None = param("1", "teeth of the ring over teeth of the sun", default=None, above=0.0)
    teeth_sun: int | None = param("1", "teeth of the sun", default=None, above=0.0, whole=True)
    teeth_ring: int | None = param("1", "teeth of the ring, counted positive", default=None, above=0.0, whole=True)

    def problems(self) -> Found:
        sun, ring = self.teeth_sun, self.teeth_ring
        found = ratio_problems(self, "ratio", ("teeth_sun", "teeth_ring"))
        if not found and sun is not None and ring is not None and ring <= sun:
            return [("teeth_ring", f"is {ring:g}, not above teeth_sun = {sun:g}", "a ring has more teeth than its sun")]
        return found

    def exact_ratio(self) -> Fraction:
        """Ratio as a fraction."""
        return ratio_of(self.ratio, self.teeth_ring, self.teeth_sun)
