"""Torque linear in speed."""

from __future__ import annotations

from clutchwork.declare import Component, Node, Role, component, flag, param, port


@component(Role.TORQUE, hooks=("edges", "edge"))
class LinearTorque(Component):
    """Torque `nominal_torque * speed / nominal_speed` on a shaft, speed relative to the base.

    Use it for simple loads; a load that brakes has a negative nominal torque. With `same_direction` the
    torque follows abs(speed / nominal_speed): it acts in the same direction at all speeds.
    """

    shaft: Node = port("shaft that a positive torque accelerates")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    nominal_torque: float = param("N m", "torque at nominal speed", units=("N",))
    nominal_speed: float = param("rad/s", "speed of the nominal torque", above=0.0, units=("m/s",))
    same_direction: bool = flag("whether it acts in the same direction at all speeds", default=False)

    def drives(self) -> bool:
        """With a positive torque."""
        return self.nominal_torque > 0.0
