"""Resistance of a vehicle on a road."""

from __future__ import annotations

from collections.abc import Iterator

from clutchwork.declare import Component, Found, Node, Role, SignalLike, component, option, param, port, signal
from clutchwork.elements.air_drag import AirDrag
from clutchwork.elements.grade import Grade
from clutchwork.elements.rolling_resistance import RollingResistance
from clutchwork.laws.coefficient_table import CoefficientTable
from clutchwork.laws.coulomb import Coulomb


@component(Role.COMPOSITE)
class Vehicle(Component):
    """Road and air forces on the mass of a vehicle: grade, drag, and rolling resistance that holds at rest.

    `-m g sin(a) - density/2 area (v - wind) abs(v - wind) - R`, `a = atan(slope)`, with the rolling resistance
    `R = sign(v) m g cos(a) (rolling_coefficient + rolling_rise abs(v))`. At rest the vehicle stays while all other
    forces are at most `m g cos(a) rolling_coefficient`. The slope is a number, a signal, or a `Road`, whose elevation
    is a table over the position. Its parts are `grade`, `drag` and `rolling`.

    Source: T. D. Gillespie, Fundamentals of Vehicle Dynamics, SAE 1992, chapter 4.
    """

    mass: Node = port("mass that drives", domain="translation")
    drag_area: float = param("m2", "frontal area times drag coefficient", default=0.0, at_least=0.0)
    air_density: float = param("kg/m3", "density of the air", default=1.2, above=0.0)
    wind: SignalLike = signal("m/s", "speed of the air along the road, positive from behind", default=0.0)
    rolling_coefficient: float = param("1", "rolling resistance over normal force", default=0.012, at_least=0.0)
    rolling_rise: float = param("s/m", "rise of that coefficient with the speed", default=0.0, at_least=0.0)
    slope: SignalLike = signal("1", "rise over horizontal distance, positive uphill", default=0.0)
    gravity: float = param("m/s2", "acceleration of gravity", default=9.80665, above=0.0)
    locked: bool = option("1", "held at rest at the start", default=False, flag=True)

    def problems(self) -> Found:
        if self.mass.inertia > 0.0:
            return []
        return [("mass", f"{self.mass.name!r} has no mass, so no weight", "give the mass of the vehicle to it")]

    def parts(self) -> Iterator[Component]:
        """Grade, drag and rolling resistance."""
        weight = float(self.mass.inertia * self.gravity)
        yield Grade(f"{self.name}.grade", shaft=self.mass, weight=weight, slope=self.slope)
        yield AirDrag(
            f"{self.name}.drag", shaft=self.mass, area=self.drag_area, density=self.air_density, wind=self.wind
        )
        yield RollingResistance(
            f"{self.name}.rolling",
            shaft=self.mass,
            weight=weight,
            slope=self.slope,
            friction=self._rolling(),
            locked=self.locked,
        )

    def _rolling(self) -> Coulomb | CoefficientTable:
        """The rolling coefficient over the speed."""
        at_rest = float(self.rolling_coefficient)
        if not self.rolling_rise:
            return Coulomb(static=at_rest, kinetic=at_rest)
        # a line through its values at rest and at 100 m/s
        line = ((0.0, at_rest), (100.0, at_rest + 100.0 * float(self.rolling_rise)))
        return CoefficientTable(static=at_rest, kinetic=line, extrapolation="linear")
