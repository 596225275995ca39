"""Play between rigid flanks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from clutchwork.declare import Found, Node, Role, component, option, param, port
from clutchwork.elements.bases.stop import Stop


@component(Role.CONTACT, hooks=("end", "restitution", "rest_speed"))
class Backlash(Stop):
    """Play between rigid flanks: free inside the gap, impacts and any pushing torque at its ends.

    Use it for gears, splines and couplings whose flanks are much stiffer than everything else; `ElasticBacklash` has
    elastic ones. The twist is at most half the gap in both directions. A flank hit at the speed s is left at
    `restitution` s, in one impact of all contacts that are closed; below `rest_speed` it holds, until its torque would
    pull.

    Source of the impact law: J. J. Moreau 1988, doi:10.1007/978-3-7091-2624-0_1.
    """

    reports: ClassVar[Mapping[str, str]] = {"position": "twist, 0 in the middle of the gap"}

    base: Node = port("side that the twist is measured from")
    follower: Node = port("side whose motion is positive")
    gap: float = param("rad", "play from one flank to the other", above=0.0, units=("m",), example=0.02)
    restitution: float = param("1", "speed after an impact over that before", default=0.0, at_least=0.0, at_most=1.0)
    rest_speed: float = param("rad/s", "speed below which it does not bounce", default=1e-6, above=0.0, units=("m/s",))
    initial_twist: float = option("rad", "twist at the start, 0 in the middle of the gap", default=0.0, units=("m",))

    def problems(self) -> Found:
        if abs(self.initial_twist) <= self.gap / 2:
            return []
        bound = f"is {self.initial_twist:g} rad, outside the gap of {self.gap:g} rad"
        return [("initial_twist", bound, f"give at most {self.gap / 2:g} rad to either side")]

    def rests(self) -> bool:
        """Whether it is at a flank at the start."""
        return abs(self.initial_twist) == self.gap / 2

    def initial_states(self) -> tuple[float, ...]:
        """Twist at the start [rad]."""
        return (self.initial_twist,)
