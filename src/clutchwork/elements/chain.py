"""Chain or toothed belt."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Component, Node, Role, component, exact, param, port


@component(Role.GEAR)
class Chain(Component):
    """Chain or toothed belt over two sprockets, which turn the same way: ratio = teeth_output/teeth_input.

    Use it for bicycle, motorcycle, timing and transfer case drives. The mean ratio is exact, a short shaft of the
    chain is a `SpringDamper` beside it.
    """

    input: Node = port("shaft whose speed is ratio times that of the output")
    output: Node = port("other shaft")
    support: Node | None = port("member that carries both and takes the reaction", default=None)
    teeth_input: int = param("1", "teeth of the sprocket on the input", above=0.0, whole=True)
    teeth_output: int = param("1", "teeth of the sprocket on the output", above=0.0, whole=True)

    def exact_ratio(self) -> Fraction:
        """Ratio as a fraction."""
        return exact(self.teeth_output) / exact(self.teeth_input)

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        ratio = self.exact_ratio()
        return [{"input": Fraction(1), "output": -ratio, "support": ratio - 1}]
