"""Value that a Python function sets."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from clutchwork.declare import Role, Sampling, Segment, Signal, component, function, param


@component(Role.SIGNAL)
class Sampled(Signal):
    """Controller: `function(time, readings)` gives the value every `period` seconds, held in between.

    Use it for a control law that reads speeds and sets a pressure. `readings` maps names of signals, such as
    "engine.speed" [rad/s] and "c1.torque" [N m], to their values just before that time. The first call, at 0 s, reads
    the start with all such values 0. A step of the value acts as a step of a `Table`. A model file cannot hold one.
    """

    function: Callable[[float, Mapping[str, float]], float] = function(
        "called with time [s] and readings", kw_only=False
    )
    period: float = param("s", "time from one call to the next", above=0.0, kw_only=False)

    def segments(self) -> tuple[Segment, ...]:
        """None: the value comes from outside."""
        return ()

    def sampling(self) -> Sampling:
        """Period and function."""
        return Sampling(self.period, self.function)
