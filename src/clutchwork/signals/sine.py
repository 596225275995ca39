"""Sine."""

from __future__ import annotations

from math import pi

from clutchwork.declare import Role, Segment, Signal, component, param


@component(Role.SIGNAL)
class Sine(Signal):
    """`offset + amplitude exp(-damping s) sin(2 pi frequency s + phase)`, with s = t - start.

    Before `start` it is `offset`.
    """

    amplitude: float = param("*", "amplitude", difference=True)
    frequency: float = param("Hz", "frequency", at_least=0.0)
    phase: float = param("rad", "phase at the start", default=0.0)
    offset: float = param("*", "mean value, and value before the start", default=0.0)
    start: float = param("s", "time at which it starts", default=0.0)
    damping: float = param("1/s", "rate of decay of the amplitude", default=0.0, at_least=0.0)

    def segments(self) -> tuple[Segment, ...]:
        """A constant piece, then the sine."""
        sine = Segment(
            self.start,
            self.offset,
            amplitude=self.amplitude,
            omega=2 * pi * self.frequency,
            phase=self.phase,
            decay=self.damping,
        )
        return (sine,) if self.start == 0.0 else (Segment(min(0.0, self.start) - 1.0, self.offset), sine)
