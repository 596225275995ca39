"""Valve that limits a pressure, or regulates it to a command."""

from __future__ import annotations

from typing import Any

from clutchwork.declare import Component, Role, Signal, SignalLike, State, component, option, param, signal
from clutchwork.elements.bases.oil import CLEARANCE, Opening
from clutchwork.elements.bases.ratios import at_start
from clutchwork.elements.oil_volume import BAR


@component(
    Role.PROCESS,
    states=(
        State("setting", "Pa", "pressure above which it opens, the command with its lag"),
        State("loss", "J", "heat of the oil that went through since the start"),
    ),
    hooks=("drawn",),
)
class ReliefValve(Opening):
    """Valve that releases oil while the pressure is above its command, fully open at `span` above it.

    With a number as its command it is a relief valve, with a signal the regulator of a line pressure: it takes the
    surplus of the pump. It cannot raise the pressure, which falls below the command when the demand exceeds the
    delivery. A `PressureValve` as its command is a solenoid with a table over its current.

    Source: H. E. Merritt, Hydraulic Control Systems, Wiley 1967, chapter 9.
    """

    inlet: SignalLike = signal("Pa", "pressure that it limits: a volume", draws=True, example=1e6)
    outlet: SignalLike = signal("Pa", "pressure that it lets off to", default=0.0, draws=True)
    command: SignalLike = signal("Pa", "pressure at which it opens", at_least=0.0, example=1.5e6)
    span: float = param("Pa", "pressure above its setting at which it is open", default=1e5, above=0.0)
    area: float = param("m2", "area of the open valve", above=0.0, example=4e-5)
    lag: float = param("s", "time constant with which the setting follows its command", default=0.01, above=0.0)
    clearance: float = param("1", "clearance as a share of the stroke", default=CLEARANCE, above=0.0)
    initial_setting: float | None = option(
        "Pa", "setting at the start, that of the command by default", default=None, at_least=0.0
    )

    def begins_with(self) -> str:
        return "command" if self.initial_setting is None and is_known(self.command) else ""

    def initial_states(self) -> tuple[float, ...]:
        """Setting at the start [Pa]; no heat yet."""
        return (self.initial_setting if self.initial_setting is not None else command_at_start(self.command), 0.0)

    def state_scales(self) -> tuple[float, ...]:
        """The solver follows pressures in bar."""
        return (BAR, 1.0)


def command_at_start(command: Any) -> float:
    """A command [Pa] at the start: of a signal, a number or a process; 0 of anything else."""
    return at_start(command) if is_known(command) else 0.0


def is_known(command: Any) -> bool:
    """Whether a command has a value of its own at the start."""
    return isinstance(command, int | float | Signal | tuple | Component)
