"""Linear damper."""

from __future__ import annotations

from clutchwork.declare import Node, Passive, Role, component, param, port
from clutchwork.elements.bases.heating import Heating


@component(Role.TORQUE)
class Damper(Heating):
    """Viscous coupling: the torque on the follower is -damping (follower - base).

    Use it for fluid couplings near synchronous speed, viscous losses and drag in oil.
    """

    base: Node = port("side that the rate is measured from")
    follower: Node = port("side whose motion is positive")
    damping: float = param("N m s/rad", "viscous damping", at_least=0.0, units=("N s/m",))

    def passive(self) -> Passive:
        return Passive(0.0, self.damping)
