"""Fixed gear ratio between two shafts."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Role, component
from clutchwork.elements.bases.teeth import WheelPair


@component(Role.GEAR)
class Gear(WheelPair):
    """Ratio = speed of the input over speed of the output, both relative to the support.

    Use it for a pair of spur gears, a chain, a belt, a final drive. Give the ratio, or the teeth of both wheels: an
    external pair turns the other way, so its ratio is -teeth_output/teeth_input; teeth of an internal wheel count
    negative.
    """

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        ratio = self.exact_ratio()
        return [{"input": Fraction(1), "output": -ratio, "support": ratio - 1}]
