"""Torque over time."""

from __future__ import annotations

from clutchwork.declare import Component, Node, Role, SignalLike, component, port, signal
from clutchwork.elements.bases.driving import signal_drives


@component(Role.TORQUE)
class Torque(Component):
    """Prescribed torque on a shaft, with its reaction on the base.

    Use it for loads, motors and engines whose torque is known over time. On a mass it is a force.
    """

    shaft: Node = port("shaft that a positive torque accelerates")
    base: Node | None = port("member that takes the reaction", default=None)
    torque: SignalLike = signal("N m", "torque on the shaft", units=("N",))

    def drives(self) -> bool:
        """Whether it drives or loads the shaft, by the sign of its largest torque over time."""
        return signal_drives(self.torque)
