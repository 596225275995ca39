"""Accumulator of oil."""

from __future__ import annotations

from math import isclose
from typing import ClassVar

from clutchwork.declare import Component, Found, Role, SignalLike, State, choice, component, option, param, signal
from clutchwork.elements.oil_volume import BAR

AMBIENT = 101325.0  # Pa
# of a gas [1], and of a spring [Pa/m3], where nothing is given
EXPONENT, RATE = 1.2, 5e9


@component(
    Role.PROCESS,
    states=(
        State("pressure", "Pa", "pressure of the oil"),
        State("energy", "J", "work of what flowed in since the start, less that of what flowed out: it is stored"),
    ),
    hooks=("margin", "cross"),
)
class Accumulator(Component):
    """Oil under the pressure of a gas or a spring; elements with it at a port fill and empty it, as an `OilVolume`.

    Below `precharge` it is empty. Above it a gas is compressed from `capacity` on, with `pressure volume^exponent`
    constant at absolute pressures; a spring yields in proportion to the pressure, until it is full. The oil of `volume`
    is always there, so that the pressure has a finite rate when it is empty or full.

    Source: H. E. Merritt, Hydraulic Control Systems, Wiley 1967; H. Murrenhoff, Grundlagen der Fluidtechnik 1, 2016.
    """

    gathers: ClassVar[bool] = True

    against: str = choice("what presses the oil", choices=("gas", "spring"), default="gas")
    precharge: float = param("Pa", "pressure at which oil begins to enter", above=0.0, example=5e5)
    capacity: float = param("m3", "volume of the gas there; of a spring the oil that fills it", above=0.0, example=2e-4)
    exponent: float = param("1", "of a gas: its exponent, 1 slow, 1.4 fast", default=EXPONENT, at_least=1.0)
    rate: float = param("Pa/m3", "of a spring: pressure per volume", default=RATE, above=0.0)
    volume: float = param("m3", "oil that is there always", default=2e-5, above=0.0)
    bulk_modulus: float = param("Pa", "bulk modulus of the oil", default=1.4e9, above=0.0)
    inflow: SignalLike = signal("m3/s", "a flow into it from outside", default=0.0)
    initial_pressure: float = option("Pa", "pressure at the start", default=0.0, at_least=0.0)

    def problems(self) -> Found:
        """A number of the other kind, which would be ignored."""
        other = {"gas": "rate", "spring": "exponent"}.get(self.against)
        # a default that was written in another unit is off by round-off
        usual = {"rate": RATE, "exponent": EXPONENT}
        if other is None or isclose(getattr(self, other), usual[other], rel_tol=1e-9):
            return []
        return [(other, f"has no meaning against a {self.against}", "leave it out")]

    def initial_states(self) -> tuple[float, ...]:
        """Pressure at the start [Pa]; no work yet."""
        return (self.initial_pressure, 0.0)

    def state_scales(self) -> tuple[float, ...]:
        """The solver follows the pressure in bar."""
        return (BAR, 1.0)

    def oil(self, pressure: float) -> float:
        """Oil that has entered at a pressure [Pa], without what is compressed [m3]."""
        if pressure <= self.precharge:
            return 0.0
        if self.against == "spring":
            return min(self.capacity, (pressure - self.precharge) / self.rate)
        ratio: float = ((self.precharge + AMBIENT) / (pressure + AMBIENT)) ** (1.0 / self.exponent)
        return self.capacity * (1.0 - ratio)
