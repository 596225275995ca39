"""Torque quadratic in speed."""

from __future__ import annotations

from clutchwork.declare import Role, component
from clutchwork.elements.bases.driving import NominalTorque


@component(Role.TORQUE, hooks=("edges", "edge"))
class QuadraticTorque(NominalTorque):
    """Torque `nominal_torque * x abs(x)` on a shaft, x = speed / nominal_speed, speed relative to the base.

    Use it for fans, pumps and air drag; a load that brakes has a negative nominal torque. With
    `same_direction` the torque follows x^2: it acts in the same direction at all speeds.
    """
