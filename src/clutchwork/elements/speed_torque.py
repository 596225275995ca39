"""Torque over speed as a table."""

from __future__ import annotations

from clutchwork.declare import Component, Node, Points, Role, component, curve, param, port
from clutchwork.elements.bases.driving import drives_by


@component(Role.TORQUE, hooks=("edges", "edge"))
class SpeedTorque(Component):
    """Torque as a table over the speed of a shaft relative to its base, continued linearly beyond both ends.

    Use it for the full-load line of an engine, motors and measured losses.
    """

    shaft: Node = port("shaft that a positive torque accelerates")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    torque: Points = curve("rad/s", "N m", "torque on the shaft over speed", units=("N",), units_x=("m/s",))
    gain: float = param("1", "factor on the torque", default=1.0)

    def drives(self) -> bool:
        """Whether its table drives more than it brakes."""
        return drives_by(self.gain * float(torque) for _, torque in self.torque)
