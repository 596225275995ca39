"""Weight on a slope."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from clutchwork.declare import Component, Node, Role, SignalLike, State, Work, component, param, port, signal


@component(Role.TORQUE, states=(State("height", "m", "height climbed since the start"),))
class Grade(Component):
    """Downhill force of a weight, `-weight sin(a)` with `a = atan(slope)`; the work of lifting is stored.

    Use it for a vehicle on a grade; `Vehicle` holds one. The slope is a number, a signal or a `Road`.
    """

    work: ClassVar[Work] = Work.STORE

    shaft: Node = port("mass that climbs", domain="translation")
    weight: float = param("N", "weight of all that climbs with it", above=0.0)
    slope: SignalLike = signal("1", "rise over horizontal distance, positive uphill", default=0.0, example=0.05)

    def initial_states(self) -> tuple[float, ...]:
        """Height at the start [m]."""
        return (0.0,)

    def stored(self, states: Sequence[float], torque: float) -> float:  # noqa: ARG002, the height alone
        """Potential energy [J]."""
        return self.weight * states[0]
