"""Constant value."""

from __future__ import annotations

from clutchwork.declare import Role, Segment, Signal, component, param


@component(Role.SIGNAL)
class Constant(Signal):
    """The same value at all times; a plain number does the same."""

    value: float = param("*", "value at all times", kw_only=False)

    def segments(self) -> tuple[Segment, ...]:
        """One constant piece."""
        return (Segment(0.0, self.value),)
