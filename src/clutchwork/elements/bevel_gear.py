"""Bevel gear between two shafts at a right angle."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Component, Found, Node, Role, component, param, port
from clutchwork.elements.bases.teeth import ratio_of, ratio_problems


@component(Role.GEAR)
class BevelGear(Component):
    """Bevel wheels at a right angle: input - support = ratio output.

    Use it where the axes of input and output cross at a right angle: a mitre box, the final drive of an axle, one mesh
    of a differential. The speed of the output is that about its own axis, in its bearings; a support that turns about
    the axis of the input, such as the cage of a differential, carries these bearings and has the torque -input. Give
    the ratio, or the teeth of both wheels. The positive direction of the output is yours to choose: a negative ratio
    reverses it.
    """

    input: Node = port("shaft whose speed is ratio times that of the output")
    output: Node = port("shaft across it")
    support: Node | None = port("member that turns about the axis of the input with the output in it", default=None)
    ratio: float | None = param("1", "speed of the input over speed of the output", default=None)
    teeth_input: int | None = param("1", "teeth of the input wheel", default=None, above=0.0, whole=True)
    teeth_output: int | None = param("1", "teeth of the output wheel", default=None, above=0.0, whole=True)

    def problems(self) -> Found:
        if self.ratio == 0.0:
            return [("ratio", "is zero", "give a number other than zero; a fixed shaft is the housing")]
        return ratio_problems(self, "ratio", ("teeth_input", "teeth_output"))

    def exact_ratio(self) -> Fraction:
        """Ratio as a fraction."""
        return ratio_of(self.ratio, self.teeth_output, self.teeth_input)

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        return [{"input": Fraction(1), "output": -self.exact_ratio(), "support": Fraction(-1)}]
