"""Hydraulic piston of a clutch."""

from __future__ import annotations

from clutchwork.declare import Component, Role, SignalLike, State, component, option, param, say, signal
from clutchwork.elements.bases.geometry import Found


@component(
    Role.PROCESS,
    states=(State("pressure", "Pa", "pressure on the plates; below zero: what is left to be filled"),),
    hooks=("margin", "cross"),
)
class PressureActuator(Component):
    """Piston that first fills, then follows its command with a lag and rate limits.

    Use it as the `pressure` of any contact. The return spring takes `spring` off the command. An empty piston fills
    first, in `fill_time` where the command is `fill_pressure` above the spring, and in inverse proportion else; then
    the pressure on the plates rises with the time constant `lag`. Below the pressure of the spring it empties again.
    """

    bends = True

    command: SignalLike = signal("Pa", "commanded pressure at the piston", clips=True)
    lag: float = param("s", "time constant of the pressure", above=0.0)
    fill_time: float = param("s", "time to fill at `fill_pressure`", default=0.0, at_least=0.0)
    fill_pressure: float = param("Pa", "command above the spring that fills it in `fill_time`", default=1e5, above=0.0)
    spring: float = param("Pa", "pressure that balances the return spring", default=0.0, at_least=0.0)
    rise: float = param("Pa/s", "fastest rise of the pressure, no limit by default", default=1e15, above=0.0)
    fall: float = param("Pa/s", "fastest fall of the pressure, no limit by default", default=1e15, above=0.0)
    filled: bool = option("1", "filled at the start", default=False, flag=True)
    initial_pressure: float = option("Pa", "pressure at the start, of a filled one", default=0.0, at_least=0.0)

    def problems(self) -> Found:
        if self.filled or self.initial_pressure == 0.0:
            return []
        fault = f"is {self.initial_pressure:g} Pa, but the piston is not filled"
        return [("initial_pressure", fault, f"give {say('filled = true', 'filled=True')}")]

    def takes_off(self) -> tuple[str, str]:
        return "command", "spring"

    def initial_states(self) -> tuple[float, ...]:
        """Pressure at the start [Pa]; of an empty piston negative by what it has to fill."""
        return (self.initial_pressure if self.filled else -self.fill_time * self.fill_pressure / self.lag,)
