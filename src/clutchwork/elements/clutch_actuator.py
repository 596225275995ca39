"""Piston of a clutch behind an orifice."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

from clutchwork.declare import Component, Found, Role, SignalLike, State, StateSum, component, option, param, signal


@component(
    Role.PROCESS,
    states=(
        State("force", "N", "force on the plates; below zero: `contact_rate` times the stroke left to the kiss point"),
        State("pressure", "Pa", "pressure on the piston"),
        State("loss", "J", "heat of its orifice and its seal since the start"),
    ),
    hooks=("margin", "cross", "drawn"),
)
class ClutchActuator(Component):
    """Piston that a supply fills through an orifice against its return spring, until it meets the plates.

    Use it as the `normal_force` of a contact. With `u` the supply minus the pressure, the flow is `discharge area
    sqrt(2/density) u/(u^2 + laminar_pressure^2)^(1/4)`. The pressure balances `preload`, `spring_rate` times the stroke
    and, beyond `kiss_stroke`, `contact_rate` times the remaining stroke, which is the force on the plates. Before this
    kiss point there is none. `seal_friction` can hold the piston in place. Oil in `volume` is compressed. At its stop
    the piston rests while the pressure is below the preload.

    A measured step response gives the values, the kiss pressure those of the springs, the fill time the orifice and the
    slope the contact rate: `clutchwork.fit.fit_response`.

    Source: R. Isermann, Mechatronic Systems, Springer 2005, section 10.3.
    """

    supply_pressure: SignalLike = signal("Pa", "pressure before the orifice", at_least=0.0, draws=True, example=1e6)
    orifice_area: float = param("m2", "area of the orifice", above=0.0, example=2e-6)
    piston_area: float = param("m2", "area of the piston", above=0.0, example=6e-3)
    preload: float = param("N", "force of the return spring at the stop", at_least=0.0, example=400.0)
    spring_rate: float = param("N/m", "stiffness of the return spring", above=0.0, example=1.5e5)
    kiss_stroke: float = param("m", "stroke at which the plates touch", above=0.0, example=2e-3)
    contact_rate: float = param("N/m", "stiffness of the plates", above=0.0, example=1e7)
    seal_friction: float = param("N", "friction of the seal", default=0.0, at_least=0.0)
    discharge: float = param("1", "discharge coefficient of the orifice", default=0.7, above=0.0)
    density: float = param("kg/m3", "density of the oil", default=850.0, above=0.0)
    laminar_pressure: float = param(
        "Pa", "pressure difference below which the flow is laminar, 0: never", default=1e3, at_least=0.0, example=2e4
    )
    volume: float = param("m3", "compressed volume of oil", default=0.0, at_least=0.0)
    bulk_modulus: float = param("Pa", "bulk modulus of the oil", default=1.4e9, above=0.0)
    initial_stroke: float = option("m", "stroke at the start", default=0.0, at_least=0.0)
    initial_pressure: float = option("Pa", "pressure at the start, at the stop", default=0.0, at_least=0.0)

    @property
    def kiss_pressure(self) -> float:
        """Pressure at which the plates touch, without friction of the seal [Pa]."""
        return (self.preload + self.spring_rate * self.kiss_stroke) / self.piston_area

    def fill_time(self, supply: float) -> float:
        """Time to the kiss point at a constant supply, without laminar flow, friction and compression [s]."""
        conductance = self.discharge * self.orifice_area * sqrt(2.0 / self.density)
        start, kiss = supply - self.preload / self.piston_area, supply - self.kiss_pressure
        if kiss <= 0.0:
            return float("inf")
        return 2.0 * (sqrt(start) - sqrt(kiss)) * self.piston_area**2 / (self.spring_rate * conductance)

    def problems(self) -> Found:
        if self.initial_pressure == 0.0 or self.initial_stroke == 0.0:
            return []
        fault = f"is {self.initial_pressure:g} Pa, but the piston is off its stop"
        return [("initial_pressure", fault, "remove it: the springs give the pressure there")]

    def initial_states(self) -> tuple[float, ...]:
        """Force on the plates [N] and pressure [Pa] at the start; no heat yet."""
        beyond = self.initial_stroke - self.kiss_stroke
        springs = self.preload + self.spring_rate * self.initial_stroke + self.contact_rate * max(beyond, 0.0)
        pressure = springs / self.piston_area if self.initial_stroke else self.initial_pressure
        return (self.contact_rate * beyond, pressure, 0.0)

    def state_sums(self) -> tuple[StateSum, ...]:
        """The stroke, from the force on the plates or the way that is left to them."""
        return (StateSum("stroke", "m", {"force": 1.0 / self.contact_rate}, self.kiss_stroke),)

    def stored(self, states: Sequence[float], torque: float = 0.0) -> float:  # noqa: ARG002, a piston has none
        """Energy [J] of its springs, the plates and the compressed oil, by its states."""
        force, pressure = states[0], states[1]
        stroke = self.kiss_stroke + force / self.contact_rate
        springs = (self.preload + 0.5 * self.spring_rate * stroke) * stroke
        plates = 0.5 * max(force, 0.0) ** 2 / self.contact_rate
        return springs + plates + 0.5 * self.volume / self.bulk_modulus * pressure**2
