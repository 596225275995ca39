"""Sprocket on which a chain lies as a polygon."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, pi, sin
from typing import ClassVar

from clutchwork.declare import Component, Node, Role, State, Way, Work, component, option, param, port


@component(
    Role.TORQUE,
    states=(State("angle", "rad", "angle from the middle of the link that lies on it"),),
    hooks=("ratio", "margin", "cross", "turns"),
    ways=(
        Way("mass", "the strand of the chain", domain="translation"),
        Way("shaft", "sprocket relative to the support", domain="rotation"),
    ),
)
class PolygonSprocket(Component):
    """Sprocket of a chain drive whose strand moves with radius cos(angle in the link) times its speed.

    Use it for the ripple of chains on sprockets of few teeth; `Chain` has two with `polygon=True`. The radius is that
    of the corners, pitch/(2 sin(pi/teeth)). The next link takes over at the angle where both give the chain the same
    speed; the acceleration jumps there.

    Equations: docs/theory/belts.md.
    """

    work: ClassVar[Work] = Work(0)

    shaft: Node = port("shaft of the sprocket", domain="rotation")
    mass: Node = port("strand of the chain", domain="translation")
    support: Node | None = port("member that carries the shaft and takes the reaction", default=None, domain="rotation")
    teeth: int = param("1", "teeth of the sprocket", at_least=3.0, whole=True, example=17)
    pitch: float = param("m", "length of a link", above=0.0, example=0.0127)
    phase: float = option(
        "1", "place in the link at the start, -1 to 1 from end to end", default=0.0, at_least=-1.0, at_most=1.0
    )

    @property
    def radius(self) -> float:
        """Radius of the corners of the polygon [m]."""
        return self.pitch / (2.0 * sin(pi / self.teeth))

    def directions(self) -> Mapping[str, Mapping[str, float]]:
        """The speed of the strand and that of the sprocket."""
        return {"mass": {"mass": 1}, "shaft": {"shaft": 1, "support": -1}}

    def initial_states(self) -> tuple[float, ...]:
        """Angle in the link at the start [rad]."""
        return (self.phase * pi / self.teeth,)

    def start_ratio(self) -> float:
        """Speed of the strand over that of the sprocket at the start [m]."""
        return self.radius * cos(*self.initial_states())
