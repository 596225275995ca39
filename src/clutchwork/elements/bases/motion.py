"""Common base of all prescribed motions."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Component, Found, Node, Signal, family, port
from clutchwork.declare.node import is_reference
from clutchwork.declare.schema import specs
from clutchwork.elements.bases.ratios import angle_of
from clutchwork.signals.constant import Constant


class MotionError(ValueError):
    """A motion from which no speed follows: quantity, message, value and remedy of the mistake."""

    def __init__(self, quantity: str, message: str, value: str, remedy: str) -> None:
        super().__init__(message)
        self.quantity, self.message, self.value, self.remedy = quantity, message, value, remedy


@family
class PrescribedMotion(Component):
    """A prescribed motion, regardless of the torque it takes."""

    # whether its speed is an integral, which begins with that of the shaft wherever a run does
    integrates: ClassVar[bool] = False

    shaft: Node = port("shaft whose motion is given")
    base: Node | None = port("member that takes the reaction and that the motion is measured from", default=None)

    def problems(self) -> Found:
        given = ((item.name, getattr(self, item.name)) for item, _ in specs(type(self), "signal"))
        remedy = "give a number or a signal, or join them by a gear"
        return [
            (name, "follows another part, and a motion is given over time", remedy)
            for name, value in given
            if is_reference(value)
        ]

    def speed_signal(self, speed: float) -> Signal:
        """The speed from the base that the shaft is given, over time; `MotionError` where it has none.

        Parameter: speed, that at the start [rad/s, m/s], where it begins with what the shaft does.
        """
        raise NotImplementedError

    def drives(self) -> bool:
        """Regardless of the torque it takes."""
        return True

    def begins_with_shaft(self) -> bool:
        """Whether its speed begins with that of the shaft."""
        return self.integrates

    def start_angle(self) -> float | None:
        """Angle [rad] or position [m] from the base at the start; None: that of the shaft."""
        return None

    def _started(self) -> float:
        """Angle from the base at the start, as shaft and base say."""
        return angle_of(self.shaft) - angle_of(self.base)

    def _unit(self, rotation: str) -> str:
        """A unit of the shaft, or of a mass."""
        return rotation.replace("rad", "m") if self.shaft.domain.value == "translation" else rotation


def as_signal(given: object) -> Signal:
    """A signal, or a number as one."""
    return given if isinstance(given, Signal) else Constant(float(given))  # type: ignore[arg-type]
