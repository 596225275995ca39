"""Open differential."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Component, Node, Role, component, port


@component(Role.GEAR)
class OpenDifferential(Component):
    """Twice the speed of the carrier = sum of both sides, each of which has half of its torque.

    It is the gear of a `Differential` without friction; the final drive in front of it is a `Gear`.
    """

    carrier: Node = port("carrier of the pinions, the driven side")
    left: Node = port("one side")
    right: Node = port("other side")

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        return [{"carrier": Fraction(2), "left": Fraction(-1), "right": Fraction(-1)}]
