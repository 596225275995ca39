"""Step."""

from __future__ import annotations

from clutchwork.declare import Role, Segment, Signal, component, param


@component(Role.SIGNAL)
class Step(Signal):
    """`offset` before `start`, `offset + height` from then on."""

    height: float = param("*", "size of the jump", difference=True)
    start: float = param("s", "time of the jump", default=0.0)
    offset: float = param("*", "value before the jump", default=0.0)

    def segments(self) -> tuple[Segment, ...]:
        """A constant piece before the jump, one after it."""
        return (Segment(min(0.0, self.start) - 1.0, self.offset), Segment(self.start, self.offset + self.height))
