"""Angle or distance between two members, as a state."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Component, Node, Role, State, Work, component, option, port


@component(Role.TORQUE, states=(State("position", "rad", "follower - base", span=1e-7),))
class Displacement(Component):
    """Angle or distance between two members, integrated with the motion; it has no torque.

    Use it where a twist or a gap must be accurate to the tolerances of the run, rather than the difference of two large
    angles. Stops have their own.
    """

    work: ClassVar[Work] = Work.STORE

    base: Node = port("side that it is measured from")
    follower: Node = port("side whose motion is positive")
    initial_position: float = option("rad", "position at the start", default=0.0, units=("m",))

    def initial_states(self) -> tuple[float, ...]:
        """Position at the start [rad]."""
        return (self.initial_position,)
