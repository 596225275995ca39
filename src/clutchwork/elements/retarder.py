"""Hydrodynamic retarder."""

from __future__ import annotations

from clutchwork.declare import Node, Role, SignalLike, State, component, option, param, port, signal
from clutchwork.elements.bases.heating import Heating


@component(Role.TORQUE, states=(State("filling", "1", "share of the full torque"),), hooks=("edges", "edge", "count"))
class Retarder(Heating):
    """Brake `-filling min(capacity w^2, max_torque, max_power/abs(w))` against the speed w; no torque at rest.

    Use it for hydrodynamic retarders of trucks and rail cars: at low speed the filled ring limits the torque, then the
    valve, then the cooler. The filling follows the command with the time constant `lag`.
    """

    shaft: Node = port("shaft that is braked")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    capacity: float = param(
        "N m s2/rad2", "torque over the square of the speed, filled", above=0.0, units=("N s2/m2",), example=0.05
    )
    max_torque: float = param(
        "N m", "largest torque, no limit by default", default=1e15, above=0.0, units=("N",), example=800.0
    )
    max_power: float = param("W", "largest power, no limit by default", default=1e15, above=0.0, example=1e5)
    command: SignalLike = signal("1", "commanded filling, 0 empty, 1 full", at_least=0.0, at_most=1.0, default=1.0)
    lag: float = param(
        "s", "time constant of the filling, 0: it follows at once", default=0.0, at_least=0.0, fixed=True, example=0.1
    )
    initial_filling: float = option("1", "filling at the start", default=0.0, at_least=0.0, at_most=1.0)

    def own_states(self) -> tuple[State, ...]:
        """The filling, where it lags."""
        return self.states if self.lag > 0.0 else ()

    def initial_states(self) -> tuple[float, ...]:
        """Filling at the start [1]."""
        return (self.initial_filling,) if self.lag > 0.0 else ()
