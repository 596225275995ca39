"""Fixed gear ratio between two shafts."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Component, Node, Role, component, exact, param, port


@component(Role.GEAR)
class Gear(Component):
    """Ratio = speed of the input over speed of the output, both relative to the support.

    Use it for a pair of spur gears, a chain, a belt, a final drive. Give the ratio, or the teeth of both wheels: an
    external pair turns the other way, so its ratio is -teeth_output/teeth_input; teeth of an internal wheel count
    negative.
    """

    input: Node = port("shaft whose speed is ratio times that of the output")
    output: Node = port("other shaft")
    support: Node | None = port("member that carries the gear and takes the reaction", default=None)
    ratio: float | None = param("1", "speed of the input over speed of the output", default=None)
    teeth_input: int | None = param("1", "teeth of the input wheel, negative if internal", default=None, whole=True)
    teeth_output: int | None = param("1", "teeth of the output wheel, negative if internal", default=None, whole=True)

    def problems(self) -> list[tuple[str, str, str]]:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        wheels = self.teeth_input, self.teeth_output
        if self.ratio is None and None in wheels:
            return [("ratio", "is missing", "give `ratio`, or both `teeth_input` and `teeth_output`")]
        if self.ratio is not None and wheels != (None, None):
            return [("ratio", "is given twice, as a number and by teeth", "give only one of the two")]
        zero = [name for name in ("ratio", "teeth_input", "teeth_output") if getattr(self, name) == 0]
        return [(name, "is zero", "give a number other than zero; a fixed shaft is the housing") for name in zero]

    def exact_ratio(self) -> Fraction:
        """Ratio as a fraction."""
        if self.ratio is not None:
            return exact(self.ratio)
        return -exact(self.teeth_output or 0) / exact(self.teeth_input or 1)

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        ratio = self.exact_ratio()
        return [{"input": Fraction(1), "output": -ratio, "support": ratio - 1}]
