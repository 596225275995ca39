"""Ramp."""

from __future__ import annotations

from clutchwork.declare import Role, Segment, Signal, component, param


@component(Role.SIGNAL)
class Ramp(Signal):
    """From `offset` at `start` linearly to `offset + height` after `duration`, constant before and after."""

    height: float = param("*", "change over the whole ramp", difference=True)
    duration: float = param("s", "time that the change takes", above=0.0)
    start: float = param("s", "time at which the change starts", default=0.0)
    offset: float = param("*", "value before the ramp", default=0.0)

    def segments(self) -> tuple[Segment, ...]:
        """Constant, linear, constant."""
        return (
            Segment(min(0.0, self.start) - 1.0, self.offset),
            Segment(self.start, self.offset, self.height / self.duration),
            Segment(self.start + self.duration, self.offset + self.height),
        )
