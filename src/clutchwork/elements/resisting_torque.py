"""Load that opposes the motion."""

from __future__ import annotations

from clutchwork.declare import Node, Role, SignalLike, component, param, port, signal
from clutchwork.elements.bases.heating import Heating


@component(Role.TORQUE)
class ResistingTorque(Heating):
    """Torque `-torque * tanh(speed_of_shaft / speed)`: full size against the motion, none at rest.

    Use it for a road load that must not turn the shaft backward. For exact sticking use `BearingFriction`.
    """

    shaft: Node = port("shaft that is braked")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    torque: SignalLike = signal("N m", "size of the torque", units=("N",))
    speed: float = param("rad/s", "speed at which 76 % of it acts", above=0.0, units=("m/s",))
