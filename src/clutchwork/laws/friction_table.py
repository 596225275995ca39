"""Kinetic coefficient over slip as a table."""

from __future__ import annotations

from clutchwork.declare import Points, Role, component, curve, param
from clutchwork.laws.bases.tables import Found, Tabulated, continued, crossing, few_points, not_positive, slip_axis


@component(Role.LAW, hooks=("edges", "edge", "outside"))
class FrictionTable(Tabulated):
    """Kinetic coefficient over abs(slip) as a table, linear or smooth, and one static coefficient above all of it.

    Use it for measured linings at one temperature. It never goes below zero, however far it is extrapolated.

    Source of the smooth one: F. N. Fritsch, R. E. Carlson 1980, doi:10.1137/0717021.
    """

    static: float = param("1", "coefficient at rest, above every kinetic one", above=0.0, example=0.35)
    kinetic: Points = curve(
        "rad/s",
        "1",
        "kinetic coefficient over abs(slip), from 0",
        units_x=("m/s",),
        example=((0.0, 0.3), (50.0, 0.28), (100.0, 0.27)),
    )

    def problems(self) -> Found:
        slips, values = [x for x, _ in self.kinetic], [y for _, y in self.kinetic]
        found = few_points("kinetic", len(slips), self.interpolation) + slip_axis("kinetic", slips[0], "rad/s")
        found += not_positive("kinetic", values, "rad/s", slips)
        return found + crossing([self.static] * len(slips), values, "rad/s", slips)

    def advice(self) -> Found:
        """A continuation that falls to zero."""
        return continued("kinetic", [self.kinetic], "rad/s", self.extrapolation, self.interpolation)

    def sliding(self) -> float:
        return float(self.kinetic[0][1])
