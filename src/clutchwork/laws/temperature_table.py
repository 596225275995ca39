"""Coefficients over the temperature as tables."""

from __future__ import annotations

from clutchwork.declare import Points, Role, SignalLike, component, curve, signal
from clutchwork.laws.bases.tables import Found, Tabulated, continued, crossing, few_points, not_positive


@component(Role.LAW, hooks=("outside", "margin", "cross", "turns", "settle"))
class TemperatureTable(Tabulated):
    """Static and kinetic coefficient over the temperature, both at the same temperatures.

    Use it for linings that fade. The temperature is that of the thermal node at the contact unless it is given.

    Source of the smooth one: F. N. Fritsch, R. E. Carlson 1980, doi:10.1137/0717021.
    """

    static: Points = curve("K", "1", "coefficient at rest", example=((280.0, 0.35), (400.0, 0.33), (500.0, 0.28)))
    kinetic: Points = curve(
        "K",
        "1",
        "coefficient while it slips, below the static one",
        example=((280.0, 0.3), (400.0, 0.29), (500.0, 0.2)),
    )
    temperature: SignalLike | None = signal("K", "temperature of the lining", default=None)

    def problems(self) -> Found:
        (places, static), (others, kinetic) = (zip(*points, strict=True) for points in (self.static, self.kinetic))
        found = few_points("static", len(places), self.interpolation)
        found += not_positive("static", static, "K", places) + not_positive("kinetic", kinetic, "K", others)
        if places != others:
            return [*found, ("kinetic", "has other temperatures than static", "give both at the same temperatures")]
        return found + crossing(static, kinetic, "K", places)

    def advice(self) -> Found:
        """Continuations that fall to zero."""
        # the static coefficient is above the kinetic one wherever that is above zero
        return continued("kinetic", [self.kinetic], "K", self.extrapolation, self.interpolation)

    def sliding(self) -> float | None:
        """None: it depends on the temperature."""
        return None
