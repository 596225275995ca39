"""Coefficient of friction over slip as a table."""

from __future__ import annotations

from clutchwork.node import Law, Points
from clutchwork.schema import Role, component, curve, param


@component(Role.LAW)
class CoefficientTable(Law):
    """Kinetic coefficient linear between the points of a table over abs(slip), continued linearly beyond its end.

    Use it for measured linings. A first point above zero slip is continued linearly down to zero.
    """

    static: float = param("1", "coefficient at rest", at_least=0.0)
    kinetic: Points = curve("rad/s", "1", "kinetic coefficient over abs(slip)")

    def sliding(self) -> float:
        """Kinetic coefficient at vanishing slip."""
        (x, y), *rest = self.kinetic
        return y - x * (rest[0][1] - y) / (rest[0][0] - x) if rest else y
