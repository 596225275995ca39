"""Crank that drives a mass."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, sin, sqrt
from typing import ClassVar

from clutchwork.declare import Component, Found, Node, Role, State, Way, Work, component, option, param, port
from clutchwork.elements.bases.ratios import Rates, angle_of, beyond_rounding


@component(
    Role.TORQUE,
    states=(State("angle", "rad", "angle of the crank, 0 where the mass is farthest out"),),
    hooks=("ratio",),
    ways=(
        Way("mass", "mass along its guide", domain="translation"),
        Way("shaft", "crank shaft relative to the support", domain="rotation"),
    ),
)
class CrankSlider(Component):
    """Crank and rod without mass: position of the mass = radius cos(angle) + sqrt(rod^2 - radius^2 sin^2(angle)).

    Use it for presses, pumps, and pistons of engines whose gas force is a torque or a force of its own. The torque on
    the shaft is minus the derivative of that position times the force on the mass.

    Equations: docs/theory/varying-ratios.md.
    """

    work: ClassVar[Work] = Work(0)

    shaft: Node = port("crank shaft", domain="rotation")
    mass: Node = port("mass on a straight guide, positive outward", domain="translation")
    support: Node | None = port("member that carries the shaft and takes the reaction", default=None, domain="rotation")
    radius: float = param("m", "radius of the crank", above=0.0, example=0.05)
    rod: float = param("m", "length of the rod, above the radius", above=0.0, example=0.15)
    phase: float = option("rad", "angle of the crank where the angle of the shaft is 0", default=0.0)

    def problems(self) -> Found:
        if self.rod > self.radius:
            return []
        fault = f"is {self.rod:g} m, not above the radius {self.radius:g} m"
        return [("rod", fault, "give a longer rod: this one cannot turn")]

    def directions(self) -> Mapping[str, Rates]:
        """The speed of the mass and that of the shaft."""
        return {"mass": {"mass": 1}, "shaft": {"shaft": 1, "support": -1}}

    def initial_states(self) -> tuple[float, ...]:
        """Angle at the start [rad]."""
        return (angle_of(self.shaft) - angle_of(self.support) + self.phase,)

    def start_positions(self) -> tuple[tuple[Node, float], ...]:
        """Where it holds the mass at the start [m]."""
        (angle,) = self.initial_states()
        along = self.rod * sqrt(1.0 - (self.radius / self.rod * sin(angle)) ** 2)
        return ((self.mass, self.radius * cos(angle) + along),)

    def start_ratio(self) -> float:
        """Speed of the mass over that of the shaft at the start [m]."""
        (angle,) = self.initial_states()
        x = self.radius * sin(angle)
        return beyond_rounding(-x - x * self.radius * cos(angle) / sqrt(self.rod**2 - x**2), self.radius)
