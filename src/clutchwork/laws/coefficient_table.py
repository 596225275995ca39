"""Coefficient of friction over slip as a table."""

from __future__ import annotations

from clutchwork.node import Law, Points
from clutchwork.schema import Role, component, curve, param


@component(Role.LAW)
class CoefficientTable(Law):
    """Kinetic coefficient linear between the points of a table over abs(slip), continued linearly beyond its end.

    Use it for measured linings. A first point above zero slip is continued linearly down to zero.
    """

    static: float = param("1", "coefficient at rest", at_least=0.0, example=0.13)
    kinetic: Points = curve(
        "rad/s", "1", "kinetic coefficient over abs(slip)", units_x=("m/s",), example=((0.0, 0.12), (20.0, 0.1))
    )

    def problems(self) -> list[tuple[str, str, str]]:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        for number, (x, y) in enumerate(self.kinetic, 1):
            if x < 0.0 or y < 0.0:
                fault = f"point {number} is ({x:g}, {y:g})"
                return [("kinetic", fault, "give coefficients >= 0 over abs(slip) >= 0")]
        return []

    def sliding(self) -> float:
        """Kinetic coefficient at vanishing slip."""
        (x, y), *rest = self.kinetic
        return y - x * (rest[0][1] - y) / (rest[0][0] - x) if rest else y
