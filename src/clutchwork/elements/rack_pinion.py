"""Rack and pinion."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Component, Found, Node, Role, component, exact, param, port


@component(Role.GEAR)
class RackPinion(Component):
    """Rack that a pinion moves: speed of the mass = radius times speed of the shaft relative to the support.

    Use it for steering gears and linear axes. Give the radius of the pitch circle, or teeth and module: radius =
    module teeth/2.
    """

    shaft: Node = port("shaft of the pinion", domain="rotation")
    mass: Node = port("rack", domain="translation")
    support: Node | None = port(
        "member that carries the pinion and takes the reaction", default=None, domain="rotation"
    )
    radius: float | None = param("m", "radius of the pitch circle", default=None, above=0.0)
    teeth: int | None = param("1", "teeth of the pinion", default=None, above=0.0, whole=True)
    module: float | None = param("m", "module, diameter of the pitch circle per tooth", default=None, above=0.0)

    def problems(self) -> Found:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        if self.radius is None and None in (self.teeth, self.module):
            return [("radius", "is missing", "give `radius`, or both `teeth` and `module`")]
        if self.radius is not None and (self.teeth, self.module) != (None, None):
            return [("radius", "is given twice, as a number and by teeth", "give only one of the two")]
        return []

    def exact_radius(self) -> Fraction:
        """Radius of the pitch circle [m] as a fraction."""
        if self.radius is not None:
            return exact(self.radius)
        return exact(self.module or 0) * exact(self.teeth or 0) / 2

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        radius = self.exact_radius()
        return [{"shaft": radius, "mass": Fraction(-1), "support": -radius}]
