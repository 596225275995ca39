"""Torsional damper: springs in stages with friction that has memory."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from clutchwork.declare import Component, Found, Node, Points, Role, component, curve, numbers, option, param, port
from clutchwork.elements.bases.heating import Heating
from clutchwork.elements.jenkins_element import JenkinsElement
from clutchwork.elements.nonlinear_spring import NonlinearSpring
from clutchwork.elements.torque_limiter import TorqueLimiter

LISTS = ("friction_limit", "friction_stiffness", "friction_load", "friction_speed")


@component(Role.COMPOSITE)
class TorsionalDamper(Heating):
    """Springs in stages between two masses, with friction in parallel: a dual-mass flywheel, a clutch disc.

    The torque on the follower is -(torque(twist) + friction + damping rate): a table over the twist, extended linearly
    beyond its ends, whose knots are stages and gaps, and any number of friction elements in parallel. Each is a spring
    of `friction_stiffness` in series with dry friction up to `friction_limit + friction_load abs(torque(twist)) +
    friction_speed w_base^2`, so that hysteresis loops close and inner loops are remembered, regardless of the rate, as
    with arc springs. `dry_friction` is rigid friction that sticks exactly. With equal amplitudes A about zero and a
    constant limit f each makes the heat 4 f (A - f/stiffness) per cycle.

    Its parts are "friction_1" and so on and "dry"; torque, power, work and heat of all count as its own.

    Equations: docs/theory/compliance.md. Source: Y. Chen, J. Shi, B. Chen 2019, doi:10.1155/2019/5808279.
    """

    base: Node = port("side that the twist is measured from, the primary mass")
    follower: Node = port("side whose motion is positive, the secondary mass")
    torque: Points = curve(
        "rad",
        "N m",
        "torque of the springs over the twist that causes it",
        units=("N",),
        units_x=("m",),
        example=((-0.6, -400.0), (-0.2, -80.0), (0.2, 80.0), (0.6, 400.0)),
    )
    damping: float = param("N m s/rad", "viscous damping", default=0.0, at_least=0.0, units=("N s/m",))
    friction_limit: Sequence[float] | None = numbers(
        "N m", "limit of each friction element", default=None, at_least=0.0, units=("N",), example=(10.0, 15.0)
    )
    friction_stiffness: Sequence[float] | None = numbers(
        "N m/rad", "stiffness of each", default=None, above=0.0, units=("N/m",), example=(1000.0, 500.0)
    )
    friction_load: Sequence[float] | None = numbers(
        "1", "share of the torque of the springs that adds to the limit of each", default=None, at_least=0.0
    )
    friction_speed: Sequence[float] | None = numbers(
        "N m s2/rad2", "what the square of the speed of the base adds to the limit of each", default=None, at_least=0.0
    )
    dry_friction: float = param("N m", "rigid friction", default=0.0, at_least=0.0, units=("N",))
    initial_twist: float = option("rad", "twist at the start", default=0.0, units=("m",))

    def problems(self) -> Found:
        given = {name: len(getattr(self, name)) for name in LISTS if getattr(self, name) is not None}
        if given and "friction_stiffness" not in given:
            remedy = "give one stiffness for each element; one without give is `dry_friction`"
            return [("friction_stiffness", "is missing", remedy)]
        wrong = [name for name in given if given[name] != given["friction_stiffness"]]
        if wrong:
            count = f"{given[wrong[0]]} numbers for {given['friction_stiffness']} of friction_stiffness"
            return [(wrong[0], f"has {count}", "give each list one number for each friction element")]
        if any(not limit and not load and not speed for _, limit, load, speed in self._elements()):
            return [
                (
                    "friction_limit",
                    "is zero for an element without friction_load and friction_speed",
                    "give it a limit, or remove it",
                )
            ]
        return []

    def parts(self) -> Iterator[Component]:
        """The springs, which have the name of the whole, and the friction beside them."""
        start: dict[str, Any] = {"initial_twist": self.initial_twist}
        yield self._part(NonlinearSpring, self.name, torque=self.torque, damping=self.damping, **start)
        for number, (stiffness, limit, load, speed) in enumerate(self._elements(), 1):
            name, limits = f"{self.name}.friction_{number}", over_torque(self.torque, limit, load) if load else limit
            pressed = {"speed_friction": speed, "speed": self.base} if speed and not self.base.fixed else {}
            yield self._part(JenkinsElement, name, stiffness=stiffness, limit=limits, **pressed, **start)
        if self.dry_friction:
            yield self._part(TorqueLimiter, f"{self.name}.dry", torque=self.dry_friction, locked=False)

    def _part(self, cls: type[Heating], name: str, **values: Any) -> Component:
        """A part between the two masses."""
        ends: dict[str, Any] = {"base": self.base, "follower": self.follower}
        return cls(name, **ends, **values, heat=self.heat, heat_share=self.heat_share)

    def sums(self) -> tuple[str, ...]:
        """The friction, which is part of its torque."""
        count = len(self.friction_stiffness or ())
        return (*(f"friction_{number}" for number in range(1, count + 1)), "dry")

    def _elements(self) -> Iterator[tuple[float, float, float, float]]:
        """Stiffness, limit, share of the load and share of the square of the speed of each friction element."""
        stiffness = self.friction_stiffness or ()
        none = (0.0,) * len(stiffness)
        others = (self.friction_limit or none, self.friction_load or none, self.friction_speed or none)
        for k, limit, load, speed in zip(stiffness, *others, strict=True):
            yield float(k), float(limit), float(load), float(speed)


def over_torque(torque: Points, limit: float, load: float) -> Points:
    """The table of limit + load abs(torque), with the points between at which the torque is zero."""
    points = [(float(x), float(y)) for x, y in torque]
    if len(points) == 1:
        return ((points[0][0], limit + load * abs(points[0][1])),)
    crossings = set[float]()
    for number, ((x0, y0), (x1, y1)) in enumerate(pairwise(points)):
        zero = x0 - y0 * (x1 - x0) / (y1 - y0) if y1 != y0 else x0
        before, after = number == 0 and zero < x0, number == len(points) - 2 and zero > x1
        if y1 != y0 and (x0 < zero < x1 or before or after):
            crossings.add(zero)
    # behind a crossing beyond the ends one more point says how it goes on
    pairs = sorted([*points, *((zero, 0.0) for zero in crossings)])
    (first, second), (last, before_last) = pairs[:2], pairs[:-3:-1]
    if first[0] in crossings:
        pairs.insert(0, (2.0 * first[0] - second[0], -second[1]))
    if last[0] in crossings:
        pairs.append((2.0 * last[0] - before_last[0], -before_last[1]))
    return tuple((x, limit + load * abs(y)) for x, y in pairs)
