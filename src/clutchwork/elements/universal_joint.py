"""Universal joint."""

from __future__ import annotations

from collections.abc import Mapping
from math import cos, pi, sin
from typing import ClassVar

from clutchwork.declare import Component, Node, Role, State, Way, Work, component, option, param, port
from clutchwork.elements.bases.ratios import Rates, angle_of


@component(
    Role.TORQUE,
    states=(State("angle", "rad", "angle of the base, counted from where its yoke lies in the plane of the bend"),),
    hooks=("ratio",),
    ways=(Way("follower", "follower relative to the support"), Way("base", "base relative to the support")),
)
class UniversalJoint(Component):
    """Cardan joint between shafts at an angle: the follower oscillates about the speed of the base twice per turn.

    Use it for propeller shafts and steering columns. tan(angle of the follower) = tan(angle of the base)/cos(bend); the
    ratio of the speeds runs between cos(bend) and 1/cos(bend). Two joints of equal bend give constant speed with `phase
    = pi/2` at the second one, and twice the error with 0.

    Equations: docs/theory/varying-ratios.md.
    Source: F. Schmelz, H.-Ch. Graf v. Seherr-Thoss, E. Aucktor, Universal Joints and Driveshafts, Springer 2006.
    """

    work: ClassVar[Work] = Work(0)

    base: Node = port("shaft whose angle it is")
    follower: Node = port("shaft at an angle to it")
    support: Node | None = port("member that carries both and takes the reaction", default=None)
    bend_angle: float = param("rad", "angle between the shafts", at_least=0.0, below=pi / 2, example=0.5)
    phase: float = option("rad", "angle of the joint where the angle of the base is 0", default=0.0)

    def directions(self) -> Mapping[str, Rates]:
        """Both rates relative to the support."""
        return {"follower": {"follower": 1, "support": -1}, "base": {"base": 1, "support": -1}}

    def initial_states(self) -> tuple[float, ...]:
        """Angle at the start [rad]."""
        return (angle_of(self.base) - angle_of(self.support) + self.phase,)

    def start_ratio(self) -> float:
        """Speed of the follower over that of the base at the start."""
        bend, (angle,) = self.bend_angle, self.initial_states()
        return cos(bend) / (1.0 - (sin(bend) * cos(angle)) ** 2)
