"""Wheel that rolls without slip."""

from __future__ import annotations

from fractions import Fraction

from clutchwork.declare import Component, Node, Role, component, exact, param, port


@component(Role.GEAR)
class RollingWheel(Component):
    """Speed of a mass = radius times speed of a shaft relative to the support.

    Use it for a wheel on the road, a rack and pinion, a winch.
    """

    shaft: Node = port("axle of the wheel", domain="rotation")
    mass: Node = port("mass that it moves", domain="translation")
    support: Node | None = port("member that carries the axle and takes the reaction", default=None, domain="rotation")
    radius: float = param("m", "rolling radius", above=0.0)

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        radius = exact(self.radius)
        return [{"shaft": radius, "mass": Fraction(-1), "support": -radius}]
