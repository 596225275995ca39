"""Diaphragm spring of a dry clutch, worked by a pedal."""

from __future__ import annotations

from clutchwork.node import Component, Points, SignalLike
from clutchwork.schema import Role, State, choice, component, curve, param, signal
from clutchwork.tables import Found, few_points


@component(Role.PROCESS, states=(State("clamp_force", "N", "force on the linings"),))
class DiaphragmSpring(Component):
    """Clamp force over the travel of the release bearing, as a table.

    Use it as the `normal_force` of a dry clutch. The travel of the bearing is `ratio * travel - free_travel`, not
    below zero: with the ratio of the linkage `travel` is that of the pedal. Wear of the linings takes the
    fingers towards the bearing by `wear_ratio` times its depth. Beyond its ends the table keeps its values.
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

    def problems(self) -> Found:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        return few_points("force", len(self.force), self.interpolation)

    def initial_states(self) -> tuple[float, ...]:
        """Clamp force at the start [N]: of a bearing that does not press."""
        return (float(self.force[0][1]),)
