"""Diaphragm spring of a dry clutch, operated by a pedal."""

from __future__ import annotations

from itertools import pairwise

from clutchwork.declare import (
    Component,
    Points,
    Role,
    Signal,
    SignalLike,
    State,
    choice,
    component,
    curve,
    option,
    param,
    signal,
)
from clutchwork.laws.bases.tables import Found, few_points
from clutchwork.signals.bases.waveform import value


@component(Role.PROCESS, states=(State("clamp_force", "N", "force on the linings"),), hooks=("margin", "cross"))
class DiaphragmSpring(Component):
    """Clamp force over the travel of the release bearing, as a table.

    Use it as the `normal_force` of a dry clutch. The travel of the bearing is `ratio * travel - free_travel`, not below
    zero: with the ratio of the linkage `travel` is that of the pedal. Wear of the linings moves the fingers towards the
    bearing by `wear_ratio` times its depth. Beyond its ends the table keeps its values.
    """

    force: Points = curve(
        "m",
        "N",
        "clamp force over the travel of the bearing",
        at_least=0.0,
        example=((0.0, 5000.0), (4e-3, 2500.0), (8e-3, 0.0)),
    )
    ratio: float = param("1", "travel of the bearing over that of the pedal", default=1.0, above=0.0)
    free_travel: float = param("m", "travel of the bearing before it touches the fingers", default=0.0, at_least=0.0)
    wear_ratio: float = param("1", "travel of the fingers per depth of wear", default=0.0)
    lag: float = param("s", "time constant of the linkage", default=2e-3, above=0.0)
    interpolation: str = choice(
        "between the points: straight lines, or smooth with a continuous slope and without overshoot",
        choices=("linear", "smooth"),
        default="smooth",
    )
    travel: SignalLike = signal("m", "travel of the bearing, or of the pedal")
    wear: SignalLike | None = signal("m", "depth of wear, none by default", default=None, otherwise=0.0)
    initial_travel: float | None = option(
        "m", "travel at the start, by default that of the signal, 0 where that is set in the run", default=None
    )

    def problems(self) -> Found:
        return few_points("force", len(self.force), self.interpolation)

    def initial_states(self) -> tuple[float, ...]:
        """Clamp force at the travel of the start [N], straight between the points."""
        travel = self.initial_travel
        if travel is None:
            travel = value(self.travel, 0.0) if isinstance(self.travel, Signal) else as_number(self.travel)
        pressed = max(self.ratio * travel - self.free_travel, 0.0)
        for (x, y), (x_next, y_next) in pairwise(self.force):
            if pressed < x_next:
                return (y + max(pressed - x, 0.0) * (y_next - y) / (x_next - x),)
        return (float(self.force[-1][1]),)


def as_number(travel: SignalLike) -> float:
    """A number, 0 for what another element gives."""
    return float(travel) if isinstance(travel, int | float) else 0.0
