"""Prescribed speed of a shaft."""

from __future__ import annotations

from clutchwork.declare import Role, Signal, SignalLike, component, option, signal
from clutchwork.elements.bases.motion import MotionError, PrescribedMotion, as_signal
from clutchwork.signals.bases.waveform import low_pass


@component(Role.MOTION)
class PrescribedSpeed(PrescribedMotion):
    """Source that gives a shaft exactly the prescribed speed, regardless of the torque.

    Use it for a speed-controlled test bench or a shaft whose speed was measured; its torque is part of the result.
    A jump of the speed becomes an impulse. With `cutoff` the speed follows the signal through a first-order
    low pass, d(speed)/dt = 2 pi cutoff (signal - speed), solved exactly; pulses and functions cannot pass it.
    """

    speed: SignalLike = signal("rad/s", "wanted speed", units=("m/s",))
    cutoff: float | None = option("Hz", "corner frequency of the low pass, none by default", default=None, above=0.0)

    def speed_signal(self, speed: float) -> Signal:  # noqa: ARG002 - it begins with what is wanted
        """The prescribed speed, or the filtered one."""
        wanted = as_signal(self.speed)
        if self.cutoff is None:
            return wanted
        try:
            return low_pass(wanted, self.cutoff)
        except ValueError as error:
            remedy = "remove cutoff, or give the speed as a table"
            raise MotionError("cutoff", str(error), f"{self.cutoff:g} Hz", remedy) from None
