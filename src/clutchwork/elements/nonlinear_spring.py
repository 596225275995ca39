"""Spring with a table of torques over the twist."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import ClassVar

from clutchwork.declare import Node, Points, Role, State, Work, component, curve, option, param, port
from clutchwork.elements.bases.heating import Heating


@component(
    Role.TORQUE,
    states=(State("twist", "rad", "follower - base, free angle taken off", span=1e-7),),
    hooks=("margin", "cross", "turns", "settle", "heat"),
)
class NonlinearSpring(Heating):
    """Spring whose torque is a table over the twist, extended linearly beyond its ends, with a damper in parallel.

    Use it for stages, gaps and springs that harden; `TorsionalDamper` adds friction. The torque on the follower is
    -(torque(twist) + damping rate), with twist = follower - base - free angle.

    Equations: docs/theory/compliance.md.
    """

    work: ClassVar[Work] = Work.STORE | Work.LOSS
    elastic: ClassVar[bool] = True

    base: Node = port("side that the twist is measured from")
    follower: Node = port("side whose motion is positive")
    torque: Points = curve(
        "rad",
        "N m",
        "torque over the twist that causes it",
        units=("N",),
        units_x=("m",),
        example=((-0.2, -300.0), (-0.1, -50.0), (0.1, 50.0), (0.2, 300.0)),
    )
    damping: float = param("N m s/rad", "viscous damping", default=0.0, at_least=0.0, units=("N s/m",), example=2.0)
    initial_twist: float = option("rad", "twist at the start, free angle taken off", default=0.0, units=("m",))

    def initial_states(self) -> tuple[float, ...]:
        """Twist at the start [rad]."""
        return (self.initial_twist,)

    def stored(self, states: Sequence[float], torque: float) -> float:  # noqa: ARG002, its twist alone tells
        """Integral of the torque over the twist [J]; from the first point of the table."""
        return area([(float(x), float(y)) for x, y in self.torque], states[0])


def area(points: Sequence[tuple[float, float]], to: float) -> float:
    """Integral of a table, extended linearly, from its first point to x."""
    if len(points) == 1:
        return points[0][1] * (to - points[0][0])
    total = 0.0
    for number, ((x0, y0), (x1, y1)) in enumerate(pairwise(points), 2):
        end = to if number == len(points) or to < x1 else x1
        width = end - x0
        total += width * (y0 + 0.5 * (y1 - y0) / (x1 - x0) * width)
        if end == to:
            break
    return total
