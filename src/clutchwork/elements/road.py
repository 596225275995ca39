"""Road under a vehicle."""

from __future__ import annotations

from itertools import pairwise

from clutchwork.declare import Component, Points, Role, SignalLike, State, component, curve, option, signal


@component(
    Role.PROCESS,
    states=(
        State("slope", "1", "rise over horizontal distance where the vehicle is"),
        State("position", "m", "horizontal distance along the road"),
    ),
    hooks=("margin", "cross", "corner"),
)
class Road(Component):
    """Slope of a road from its elevation, a table over the horizontal position of the vehicle.

    Use it as the `slope` of a `Vehicle`. The position follows the speed, `d position/dt = speed cos(a)` with
    `a = atan(slope)`, so that the height is that of the table. Between two points the slope is constant, at a point it
    jumps: an event. Before the first point and behind the last one the road is level. A vehicle may come to rest at the
    bottom of a valley, with a slope between those of both sides.
    """

    elevation: Points = curve("m", "m", "height over horizontal position", example=((0.0, 0.0), (100.0, 5.0)))
    speed: SignalLike = signal("m/s", "mass that drives on it")
    initial_position: float = option("m", "position at the start", default=0.0)

    def initial_states(self) -> tuple[float, ...]:
        """Slope and position [m] at the start."""
        at = self.initial_position
        here = [(y - x) / (b - a) for (a, x), (b, y) in pairwise(self.elevation) if a <= at < b]
        return (here[0] if here else 0.0, at)
