"""Rigid end stops."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from clutchwork.declare import HOUSING, Found, Node, Role, component, option, param, port
from clutchwork.declare.node import Domain
from clutchwork.elements.bases.ratios import angle_of
from clutchwork.elements.bases.stop import Stop


@component(Role.CONTACT, hooks=("end", "restitution", "rest_speed"))
class EndStop(Stop):
    """Rigid stops at the lower and the upper end of a travel: free between them, impacts and any pushing force at them.

    Use it for levers, pistons, slides, parking pawls and pedals, on shafts and on masses; one end may be left out.
    An end hit at the speed s is left at its restitution times s, in one impact of all contacts that are
    closed; below `rest_speed` it holds, until its force would pull. Friction beside it is a `BearingFriction`: with a
    mass and both ends they are `MassWithStopAndFriction` of the Modelica Standard Library 4.0.

    Source of the impact law: J. J. Moreau 1988, doi:10.1007/978-3-7091-2624-0_1.
    """

    reports: ClassVar[Mapping[str, str]] = {"position": "position of the follower over the base"}

    base: Node | None = port("side that the position is measured from", default=None)
    follower: Node = port("side whose motion is positive")
    lower: float | None = param("rad", "position of the lower end, none by default", default=None, units=("m",))
    upper: float | None = param(
        "rad", "position of the upper end, none by default", default=None, units=("m",), example=1.0
    )
    lower_restitution: float = param(
        "1", "speed after an impact at the lower end over that before", default=0.0, at_least=0.0, at_most=1.0
    )
    upper_restitution: float = param(
        "1", "speed after an impact at the upper end over that before", default=0.0, at_least=0.0, at_most=1.0
    )
    rest_speed: float = param("rad/s", "speed below which it does not bounce", default=1e-6, above=0.0, units=("m/s",))
    initial_position: float | None = option(
        "rad", "position at the start, by default that of follower less base", default=None, units=("m",)
    )

    def problems(self) -> Found:
        if self.lower is None and self.upper is None:
            return [("upper", "is missing, and so is lower", "give one end or both")]
        lower = float("-inf") if self.lower is None else self.lower
        upper = float("inf") if self.upper is None else self.upper
        if not lower < upper:
            return [("upper", f"is {upper:g}, not above the lower end {lower:g}", "give the ends in their order")]
        (start,) = self.initial_states()
        if lower <= start <= upper:
            return []
        end = f"below the lower end, {lower:g}" if start < lower else f"above the upper end, {upper:g}"
        return [("initial_position", f"is {start:g} at the start, {end}", "start between the ends")]

    def is_open(self) -> bool:
        ends: tuple[Any, ...] = (self.follower, self.base or HOUSING)
        if self.initial_position is not None or not all(isinstance(node, Node) for node in ends):
            return False
        return any(node.domain is Domain.TRANSLATION and node.angle is None for node in ends)

    def rests(self) -> bool:
        return self.initial_states()[0] in (self.lower, self.upper)

    def initial_states(self) -> tuple[float, ...]:
        """Position at the start [rad]."""
        if self.initial_position is not None:
            return (self.initial_position,)
        return (angle_of(self.follower) - angle_of(self.base),)
