"""Load that opposes the motion."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Node, Role, SignalLike, Work, component, param, port, signal
from clutchwork.elements.bases.heating import Heating


@component(Role.TORQUE)
class ResistingTorque(Heating):
    """Torque `-torque * tanh(speed_of_shaft / speed)`: full size against the motion, none at rest.

    Use it for a road load that must not turn the shaft backward. For exact sticking use `BearingFriction`. Its work
    counts as that of a load; the share that a thermal node takes is heat.
    """

    work: ClassVar[Work] = Work.SOURCE

    shaft: Node = port("shaft that is braked")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    torque: SignalLike = signal("N m", "size of the torque", units=("N",))
    speed: float = param("rad/s", "speed at which 76 % of it acts", above=0.0, units=("m/s",))

    def drives(self) -> bool:
        """A load."""
        return False
