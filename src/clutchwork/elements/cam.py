"""Cam and follower."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import ClassVar

from clutchwork.declare import Found, Node, Points, Role, component, curve, option, param, port
from clutchwork.declare.node import Domain, Part
from clutchwork.elements.bases.heating import Heating
from clutchwork.elements.bases.lifts import closed, curvatures, lift_problems
from clutchwork.elements.cam_profile import RISE, CamProfile
from clutchwork.elements.end_stop import EndStop


@component(Role.COMPOSITE)
class Cam(Heating):
    """Cam without mass that pushes a follower by its lift, a table over its angle, and never pulls it.

    Use it for valve trains, camshafts of pumps, presses and indexing drives; what presses the follower on the cam, a
    `Spring` or a weight, is an element of its own. The lift is the periodic spline with two continuous derivatives
    through the points of the table. The follower leaves the cam where the force between them would pull, and lands by
    an impact at `restitution` times the speed at which it closes; below `rest_speed` it stays. A follower without a
    speed of its own starts with the surface, where it touches that.

    Equations: docs/theory/varying-ratios.md.
    """

    reports: ClassVar[Mapping[str, str]] = {
        "position": "gap between cam and follower, exactly zero while they touch",
        "slip": "speed of the follower over the surface of the cam",
        "torque": "force on the follower, which only pushes",
    }

    shaft: Node = port("cam shaft", domain="rotation")
    mass: Node = port("follower on a straight guide, positive away from the cam", domain="translation")
    support: Node | None = port("member that carries the shaft and takes the reaction", default=None, domain="rotation")
    lift: Points = curve("rad", "m", "lift over the angle of the cam, one revolution that closes", example=RISE)
    restitution: float = param("1", "speed after a landing over that before", default=0.0, at_least=0.0, at_most=1.0)
    rest_speed: float = param("m/s", "speed below which the follower does not bounce", default=1e-6, above=0.0)
    phase: float = option("rad", "angle of the cam where the angle of the shaft is 0", default=0.0)
    initial_gap: float = option("m", "distance of the follower from the cam at the start", default=0.0, at_least=0.0)

    def problems(self) -> Found:
        return lift_problems(self.lift)

    def parts(self) -> Iterator[Part]:
        """The surface, which follows the shaft, and the stop between it and the follower."""
        surface = Node(f"{self.name}.surface", Domain.TRANSLATION)
        yield surface
        lift = closed(self.lift)
        yield CamProfile(
            f"{self.name}.profile",
            shaft=self.shaft,
            mass=surface,
            support=self.support,
            lift=lift,
            curvature=curvatures(lift),
            phase=self.phase,
        )
        yield EndStop(
            self.name,
            base=surface,
            follower=self.mass,
            lower=0.0,
            lower_restitution=self.restitution,
            rest_speed=self.rest_speed,
            initial_position=self.initial_gap,
            heat=self.heat,
            heat_share=self.heat_share,
        )
