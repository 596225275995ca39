"""Spring and dry friction in series."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from clutchwork.declare import (
    Found,
    Node,
    Points,
    Role,
    SignalLike,
    State,
    Work,
    component,
    curve,
    option,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.heating import Heating


@component(
    Role.TORQUE,
    states=(
        State("friction_torque", "N m", "torque of the spring", span=1e-7),
        State("twist", "rad", "follower - base", span=1e-7),
    ),
    hooks=("margin", "cross", "turns", "settle", "count", "heat", "freed"),
)
class JenkinsElement(Heating):
    """Spring in series with dry friction: it twists up to the limit of the friction, then slides.

    Use several beside a spring for hysteresis with memory, as of arc springs and friction rings, whose loops close
    whatever the rate. While it sticks its torque changes with `stiffness` times the rate; at the limit it follows the
    limit exactly, until the rate reverses. The limit is a number, or a table over the twist which is extended linearly,
    and may grow with the square of a speed, as centrifugal force presses springs onto their guide. Its stored energy is
    recovered.

    Equations: docs/theory/compliance.md. Source: W. D. Iwan, A distributed-element model for hysteresis and its
    steady-state dynamic response, J. Appl. Mech. 33, 1966, doi:10.1115/1.3625199.
    """

    work: ClassVar[Work] = Work.STORE | Work.LOSS

    base: Node = port("side that the twist is measured from")
    follower: Node = port("side whose motion is positive")
    stiffness: float = param("N m/rad", "stiffness of the spring", above=0.0, units=("N/m",), example=1e3)
    limit: float | Points = curve(
        "rad",
        "N m",
        "torque at which it slides, one number or over the twist",
        units=("N",),
        units_x=("m",),
        at_least=0.0,
        constant=True,
        example=((-0.1, 8.0), (-0.05, 5.0), (0.05, 5.0), (0.1, 8.0)),
    )
    speed_friction: float = param(
        "N m s2/rad2", "what the square of the speed adds to the limit", default=0.0, at_least=0.0, units=("N s2/m2",)
    )
    speed: SignalLike | None = signal(
        "rad/s", "speed that presses it, such as that of a shaft", default=None, otherwise=0.0, units=("m/s",)
    )
    initial_twist: float = option("rad", "twist at the start, where the limit is over it", default=0.0, units=("m",))

    def problems(self) -> Found:
        points = [(float(x), float(y)) for x, y in self._table]
        if len(points) > 1 and (points[0][1] < points[1][1] or points[-1][1] < points[-2][1]):
            return [("limit", "falls below zero beyond its ends", "repeat the values at its ends, or let them rise")]
        return []

    @property
    def _table(self) -> Points:
        return ((0.0, self.limit),) if isinstance(self.limit, int | float) else self.limit

    def own_states(self) -> tuple[State, ...]:
        """A limit that is one number needs no twist."""
        return self.states if len(self._table) > 1 else self.states[:1]

    def initial_states(self) -> tuple[float, ...]:
        """No torque of the spring, and the twist at the start [rad]."""
        return (0.0, self.initial_twist)[: len(self.own_states())]

    def stored(self, states: Sequence[float], torque: float) -> float:  # noqa: ARG002, its torque is that of the spring
        """Energy of the spring [J]."""
        return 0.5 * torque * torque / self.stiffness
