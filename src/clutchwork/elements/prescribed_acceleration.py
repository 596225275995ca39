"""Prescribed acceleration of a shaft."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Role, Signal, SignalLike, component, signal
from clutchwork.elements.bases.motion import MotionError, PrescribedMotion, as_signal
from clutchwork.signals.bases.motions import SignalError, integral


@component(Role.MOTION)
class PrescribedAcceleration(PrescribedMotion):
    """Source that accelerates a shaft or a mass exactly as prescribed, regardless of the torque.

    Use it for a measured acceleration, base excitation, or braking at a given deceleration. It starts with the speed of
    the shaft, wherever the run begins; its speed is the exact integral. Pulses and functions are refused: give the
    speed.
    """

    integrates: ClassVar[bool] = True

    acceleration: SignalLike = signal("rad/s2", "prescribed acceleration relative to the base", units=("m/s2",))

    def speed_signal(self, speed: float) -> Signal:
        """Integral of the acceleration."""
        try:
            return integral(as_signal(self.acceleration), speed)
        except SignalError as error:
            raise MotionError("acceleration", error.message, "", error.remedy) from None
