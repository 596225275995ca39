"""Linear spring and damper in parallel."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Node, Passive, Role, State, Work, component, param, port
from clutchwork.elements.bases.heating import Heating


@component(Role.TORQUE, states=(State("spring_torque", "N m", "stiffness times twist", span=1e-7),), hooks=("heat",))
class SpringDamper(Heating):
    """Elastic shaft with internal damping.

    Use it where an elastic part joins two inertias: shafts, dual-mass flywheels, tyres.
    The torque on the follower is -(stiffness twist + damping rate), with twist = follower - base - free angle.
    """

    work: ClassVar[Work] = Work.STORE | Work.LOSS
    elastic: ClassVar[bool] = True

    base: Node = port("side that the twist is measured from")
    follower: Node = port("side whose motion is positive")
    stiffness: float = param("N m/rad", "torsional stiffness", above=0.0, units=("N/m",))
    damping: float = param("N m s/rad", "viscous damping", default=0.0, at_least=0.0, units=("N s/m",))
    initial_twist: float = param("rad", "twist at the start, free angle taken off", default=0.0, units=("m",))

    def initial_states(self) -> tuple[float, ...]:
        """Spring torque at the start [N m]."""
        return (self.stiffness * self.initial_twist,)

    def passive(self) -> Passive:
        return Passive(self.stiffness, self.damping)
