"""Eddy-current brake."""

from __future__ import annotations

from math import inf

from clutchwork.declare import Found, Node, Role, Signal, SignalLike, component, param, port, signal
from clutchwork.elements.bases.heating import Heating
from clutchwork.signals.bases.extremes import extremes


@component(Role.TORQUE)
class EddyCurrentBrake(Heating):
    """Brake `-2 nominal_torque x/(1 + x^2)`, x = speed/nominal_speed: with a peak there and no torque at rest.

    Use it for magnetic brakes, eddy-current retarders and dynamometers. As its conductor warms, its resistance rises:
    the peak moves up to `nominal_speed (1 + temperature_coefficient (temperature - reference_temperature))`. The
    temperature is that of its `heat` node unless it is given.

    Source: Modelica Standard Library, Rotational.Sources.EddyCurrentTorque.
    """

    shaft: Node = port("shaft that is braked")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    nominal_torque: float = param("N m", "largest torque", above=0.0, units=("N",), example=100.0)
    nominal_speed: float = param(
        "rad/s", "speed of the largest torque at reference temperature", above=0.0, units=("m/s",), example=10.0
    )
    temperature_coefficient: float = param(
        "1/K", "rise of the resistance with the temperature, over that at reference", default=0.0, at_least=0.0
    )
    reference_temperature: float = param("K", "temperature of the nominal speed", default=293.15, above=0.0)
    temperature: SignalLike | None = signal(
        "K", "temperature of the conductor, that of its `heat` node by default", default=None, otherwise=293.15
    )

    def drives(self) -> bool:
        """A brake."""
        return False

    def problems(self) -> Found:
        if self.temperature_coefficient == 0.0:
            return []
        # the coldest that is known in advance
        coldest, given = self.reference_temperature - 1.0 / self.temperature_coefficient, self.temperature
        known = [reached.value for reached in extremes(given)] if isinstance(given, Signal) else [given]
        lowest = min((value for value in known if isinstance(value, int | float)), default=inf)
        if lowest <= coldest:
            fault = f"is {lowest:g} K, not above {coldest:g} K, where no resistance is left"
            return [("temperature", fault, "give a higher one, or a smaller coefficient")]
        if self.temperature is not None or self.heat is not None:
            return []
        fault = f"is {self.temperature_coefficient:g} 1/K, but there is no temperature"
        return [("temperature_coefficient", fault, "give `heat`, a thermal node, or `temperature`")]
