"""Torque linear in speed."""

from __future__ import annotations

from clutchwork.declare import Role, component
from clutchwork.elements.bases.driving import NominalTorque


@component(Role.TORQUE, hooks=("edges", "edge"))
class LinearTorque(NominalTorque):
    """Torque `nominal_torque * speed / nominal_speed` on a shaft, speed relative to the base.

    Use it for simple loads; a load that brakes has a negative nominal torque. With `same_direction` the
    torque follows abs(speed / nominal_speed): it acts in the same direction at all speeds.
    """
