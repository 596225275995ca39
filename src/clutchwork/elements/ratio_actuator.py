"""Actuator of a ratio that varies."""

from __future__ import annotations

from clutchwork.declare import (
    Component,
    Found,
    HeatFlow,
    Node,
    Rate,
    Role,
    SignalLike,
    State,
    ThermalNode,
    component,
    option,
    param,
    signal,
)
from clutchwork.elements.bases.ratios import at_start


@component(Role.PROCESS, states=(State("ratio", "1", "ratio that it gives"),))
class RatioActuator(Component):
    """Ratio that follows its command with a lag: `d ratio/dt = (command - ratio)/lag`.

    Use it as the `ratio` of a `VariableRatio` that a controller or a signal with jumps commands: no real drive changes
    its ratio instantly.
    """

    command: SignalLike = signal("1", "wanted ratio", example=2.0)
    lag: float = param("s", "time constant of the ratio", above=0.0, example=0.2)
    initial_ratio: float | None = option("1", "ratio at the start, that of the command by default", default=None)

    def problems(self) -> Found:
        if self.initial_ratio is None and isinstance(self.command, Node | Rate | HeatFlow | ThermalNode):
            return [("initial_ratio", "is missing, and the command says none at the start", "give the ratio there")]
        return []

    def begins_with(self) -> str:
        return "command" if self.initial_ratio is None else ""

    def initial_states(self) -> tuple[float, ...]:
        """Ratio at the start."""
        return (at_start(self.command) if self.initial_ratio is None else self.initial_ratio,)
