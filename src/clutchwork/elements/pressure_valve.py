"""Valve that turns a current into a pressure."""

from __future__ import annotations

from clutchwork.declare import Component, Points, Role, SignalLike, State, component, curve, option, param, signal


@component(Role.PROCESS, states=(State("pressure", "Pa", "pressure behind the valve"),), hooks=("margin", "cross"))
class PressureValve(Component):
    """Proportional valve: a table of its pressure over the current, followed with a lag.

    `d pressure/dt = (table(current) - pressure)/lag`. Use it as the `supply_pressure` of a `ClutchActuator`, or
    as the pressure of a contact where the piston does not matter. The table is linear between its points and held
    outside; falling ones are those of valves that open without current.
    """

    pressure: Points = curve(
        "A", "Pa", "pressure over current", at_least=0.0, example=((0.0, 0.0), (0.1, 0.0), (1.0, 1e6))
    )
    lag: float = param("s", "time constant of the pressure", above=0.0, example=0.02)
    current: SignalLike = signal("A", "current through the coil", example=0.8)
    initial_pressure: float = option("Pa", "pressure at the start", default=0.0, at_least=0.0)

    def initial_states(self) -> tuple[float, ...]:
        """Pressure at the start [Pa]."""
        return (self.initial_pressure,)
