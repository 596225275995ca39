"""Coefficient of friction over slip as a table."""

from __future__ import annotations

from clutchwork.declare import Law, Points, Role, component, curve, param
from clutchwork.laws.bases.tables import Found, beyond_the_ends, continued, slip_axis


@component(Role.LAW, hooks=("edges", "edge", "outside"))
class CoefficientTable(Law):
    """Kinetic coefficient linear between the points of a table over abs(slip).

    Use it for measured linings. Beyond its ends, below a first point above zero slip as well, it keeps the value there
    unless `extrapolation` says otherwise; it never goes below zero.
    """

    static: float = param("1", "coefficient at rest", at_least=0.0, example=0.13)
    kinetic: Points = curve(
        "rad/s", "1", "kinetic coefficient over abs(slip)", units_x=("m/s",), example=((0.0, 0.12), (20.0, 0.1))
    )
    extrapolation: str = beyond_the_ends()

    def problems(self) -> Found:
        for number, (x, y) in enumerate(self.kinetic, 1):
            if x < 0.0 or y < 0.0:
                fault = f"point {number} is ({x:g}, {y:g})"
                return [("kinetic", fault, "give coefficients >= 0 over abs(slip) >= 0")]
        if self.extrapolation == "error":
            return slip_axis("kinetic", self.kinetic[0][0], "rad/s")
        if self.sliding() < 0.0:
            fault = f"is {self.sliding():g} at 0 rad/s when it is extrapolated linearly, must be >= 0"
            return [("kinetic", fault, 'give a point at 0 rad/s, or extrapolation "nearest"')]
        return []

    def advice(self) -> Found:
        """A continuation that falls to zero."""
        return continued("kinetic", [self.kinetic], "rad/s", self.extrapolation, "linear")

    def sliding(self) -> float:
        (x, y), *rest = self.kinetic
        if not rest or self.extrapolation != "linear":
            return y
        return y - x * (rest[0][1] - y) / (rest[0][0] - x)
