"""Coefficients over temperature and slip."""

from __future__ import annotations

from collections.abc import Sequence

from clutchwork.declare import Role, SignalLike, component, numbers, signal
from clutchwork.laws.bases.tables import Found, Tabulated, continued, crossing, few_points, slip_axis


@component(Role.LAW, hooks=("edges", "edge", "outside", "fits", "margin", "cross", "turns", "settle"))
class FrictionMap(Tabulated):
    """Static coefficient over the temperature, kinetic coefficient over temperature and abs(slip).

    Use it for linings whose fall over the slip changes with the temperature. A row of `kinetic` belongs to a
    temperature, a column to a speed. The temperature is that of the thermal node at the contact unless it is given.

    Source of the smooth one: F. N. Fritsch, R. E. Carlson 1980, doi:10.1137/0717021.
    """

    temperatures: Sequence[float] = numbers(
        "K", "temperatures, rising", rising="strictly", example=(280.0, 400.0, 500.0)
    )
    speeds: Sequence[float] = numbers(
        "rad/s", "slips, rising from 0", units=("m/s",), rising="strictly", example=(0.0, 50.0, 200.0)
    )
    static: Sequence[float] = numbers(
        "1", "coefficient at rest, one for each temperature", above=0.0, example=(0.35, 0.33, 0.28)
    )
    kinetic: Sequence[Sequence[float]] = numbers(
        "1",
        "coefficient while it slips, a row over the speeds for each temperature",
        above=0.0,
        example=((0.3, 0.28, 0.25), (0.29, 0.27, 0.24), (0.22, 0.2, 0.18)),
        rows=True,
    )
    temperature: SignalLike | None = signal("K", "temperature of the lining", default=None)

    def problems(self) -> Found:
        found = few_points("temperatures", len(self.temperatures), self.interpolation)
        found += few_points("speeds", len(self.speeds), self.interpolation)
        found += slip_axis("speeds", self.speeds[0], "rad/s")
        shape = self._shape_problems()
        if shape:
            return found + shape
        for speed, column in zip(self.speeds, zip(*self.kinetic, strict=True), strict=True):
            found += crossing(self.static, column, f"K, {speed:g} rad/s", self.temperatures)
        return found

    def _shape_problems(self) -> Found:
        """Too few or too many static coefficients, rows or columns."""
        rows, columns = len(self.temperatures), len(self.speeds)
        if len(self.static) != rows:
            return [
                ("static", f"has {len(self.static)} values for {rows} temperatures", "give one for each temperature")
            ]
        if len(self.kinetic) != rows or any(len(row) != columns for row in self.kinetic):
            shape = f"{len(self.kinetic)} rows of {sorted({len(row) for row in self.kinetic})} numbers"
            fault = f"has {shape}, must have {rows} rows, one for each temperature, of {columns} numbers"
            return [("kinetic", fault, "give a row over the speeds for each temperature")]
        return []

    def advice(self) -> Found:
        """Continuations that fall to zero."""
        rows = [tuple(zip(self.speeds, row, strict=True)) for row in self.kinetic]
        columns = [tuple(zip(self.temperatures, column, strict=True)) for column in zip(*self.kinetic, strict=True)]
        found = continued("kinetic", rows, "rad/s", self.extrapolation, self.interpolation)
        # over the temperature it goes on by its last secants in either manner
        return found + continued("kinetic", columns, "K", self.extrapolation, "linear")

    def sliding(self) -> float | None:
        """None: it depends on the temperature."""
        return None
