"""Train of pulses."""

from __future__ import annotations

from clutchwork.declare import Role, Segment, Signal, component, param


@component(Role.SIGNAL)
class Pulse(Signal):
    """`offset`, and `offset + height` for `width` seconds once in every `period`, for the first time at `start`."""

    height: float = param("*", "height of a pulse", difference=True)
    period: float = param("s", "time from one pulse to the next", above=0.0)
    width: float = param("s", "duration of a pulse, shorter than the period", above=0.0)
    start: float = param("s", "time of the first pulse", default=0.0)
    offset: float = param("*", "value between pulses", default=0.0)

    def problems(self) -> list[tuple[str, str, str]]:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        if self.width < self.period:
            return []
        return [("width", f"is {self.width:g} s, not below period = {self.period:g} s", "shorten the pulse")]

    def segments(self) -> tuple[Segment, ...]:
        """The pulse and the pause after it, repeated; before the first pulse the pause holds."""
        return (Segment(self.start, self.offset + self.height), Segment(self.start + self.width, self.offset))

    def repeats(self) -> float:
        """Period [s]."""
        return self.period
