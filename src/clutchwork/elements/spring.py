"""Linear spring."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Component, Node, Passive, Role, State, Work, component, param, port


@component(Role.TORQUE, states=(State("spring_torque", "N m", "stiffness times twist", span=1e-7),))
class Spring(Component):
    """Elastic shaft without damping.

    Use it where damping does not matter; otherwise use `SpringDamper`.
    The torque on the follower is -stiffness twist, with twist = follower - base - free angle.
    """

    work: ClassVar[Work] = Work.STORE
    elastic: ClassVar[bool] = True

    base: Node = port("side that the twist is measured from")
    follower: Node = port("side whose motion is positive")
    stiffness: float = param("N m/rad", "torsional stiffness", above=0.0, units=("N/m",))
    initial_twist: float = param("rad", "twist at the start, free angle taken off", default=0.0, units=("m",))

    def initial_states(self) -> tuple[float, ...]:
        """Spring torque at the start [N m]."""
        return (self.stiffness * self.initial_twist,)

    def passive(self) -> Passive:
        return Passive(self.stiffness, 0.0)
