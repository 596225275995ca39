"""Volume of oil between valves."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Component, Role, SignalLike, State, component, option, param, signal

# one unit of pressure in the solver [Pa]
BAR = 1e5


@component(
    Role.PROCESS,
    states=(
        State("pressure", "Pa", "pressure of the oil"),
        State("energy", "J", "work of what flowed in since the start, less that of what flowed out: it is stored"),
    ),
)
class OilVolume(Component):
    """Oil in a line or behind a valve: its pressure follows the sum of all flows into it.

    Any number of elements may have it at a port and exchange oil with it: pumps, orifices, valves, pistons. `d
    pressure/dt = flow bulk_modulus/volume`; entrained air makes it soft at low pressures, so that the pressure never
    falls below vacuum. A number or a signal in place of a volume, as the port of a valve, is a fixed pressure, such as
    that of a sump.

    Equations: docs/theory/hydraulics.md. Source: H. E. Merritt, Hydraulic Control Systems, Wiley 1967, section 1-4.
    """

    gathers: ClassVar[bool] = True

    volume: float = param("m3", "oil in it", above=0.0, example=1e-4)
    bulk_modulus: float = param("Pa", "bulk modulus of the oil and of the walls", default=1.4e9, above=0.0)
    air: float = param("1", "share of air in the oil where it has no pressure", default=0.005, at_least=0.0, below=1.0)
    inflow: SignalLike = signal("m3/s", "a flow into it from outside", default=0.0)
    initial_pressure: float = option("Pa", "pressure at the start", default=0.0, above=-101325.0)

    def initial_states(self) -> tuple[float, ...]:
        """Pressure at the start [Pa]; no work yet."""
        return (self.initial_pressure, 0.0)

    def state_scales(self) -> tuple[float, ...]:
        """The solver follows the pressure in bar."""
        return (BAR, 1.0)
