"""Prescribed torques, and whether they drive their shaft."""

from __future__ import annotations

from collections.abc import Iterable
from numbers import Real
from typing import Any

from clutchwork.declare import Component, Node, Signal, family, flag, param, port
from clutchwork.signals.bases.extremes import extremes


def drives_by(torques: Iterable[float]) -> bool:
    """Whether torques over time or speed drive a shaft more than they brake it."""
    values = [*torques]
    return max(values) > 0.0 and max(values) >= -min(values)


def signal_drives(torque: Any) -> bool:
    """Whether a torque over time drives or loads its shaft; one that is known only during the run counts as a drive."""
    if isinstance(torque, Signal):
        return drives_by([reached.value for reached in extremes(torque)] or [1.0])
    return not isinstance(torque, Real) or float(torque) > 0.0


@family
class NominalTorque(Component):
    """A torque that follows from the speed, by its value at a nominal one."""

    shaft: Node = port("shaft that a positive torque accelerates")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    nominal_torque: float = param("N m", "torque at nominal speed", units=("N",))
    nominal_speed: float = param("rad/s", "speed of the nominal torque", above=0.0, units=("m/s",))
    same_direction: bool = flag("whether it acts in the same direction at all speeds", default=False)

    def drives(self) -> bool:
        """With a positive torque."""
        return self.nominal_torque > 0.0
