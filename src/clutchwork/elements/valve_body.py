"""Valve body of a gearbox."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from clutchwork.declare import Component, Found, Node, Role, SignalLike, component, named, param, port, signal
from clutchwork.elements.bases.oil import DENSITY, VISCOSITY
from clutchwork.elements.clutch_actuator import ClutchActuator
from clutchwork.elements.oil_volume import OilVolume
from clutchwork.elements.pump import Pump
from clutchwork.elements.relief_valve import ReliefValve, command_at_start
from clutchwork.elements.spool_valve import SpoolValve


@component(Role.COMPOSITE)
class ValveBody(Component):
    """Pump, line pressure, and for each shift element a spool valve and a piston.

    Use it for the pressures of a `Transmission`: a body named "body" has for the element A the valve `body.A_valve`,
    the oil behind it, `body.A_port`, and `body.A_piston`, whose force is the `normal_force` of the element:
    `shift={"A": {"normal_force": body.part("A_piston"), "gain": ...}}`. Its pump takes its torque from `shaft`; the
    line is `body.line`, which `body.regulator` holds at `line_pressure` as long as the pump covers pistons and leakage.
    Shift controllers command `body.A_valve.command`, and find valve and piston by themselves.

    Parameters are common to all elements; build anything else from a `Pump`, `SpoolValve` and `ClutchActuator`.
    The bore before a piston is turbulent at a fixed density: filling times do not follow the temperature of the oil,
    only valves, pump and leakage do.
    """

    shaft: Node = port("shaft that drives the pump")
    piston_areas: Mapping[str, float] | None = named(
        "m2", "area of the piston by element", above=0.0, example={"A": 6e-3}
    )
    pressures: Mapping[str, float] | None = named(
        "Pa", "pressure at the start by element, of those not empty", above=0.0
    )
    line_pressure: SignalLike = signal("Pa", "commanded pressure of the line", default=1.2e6, at_least=0.0)
    displacement: float = param("m3", "oil of the pump per turn", default=2e-5, above=0.0)
    efficiency: float = param("1", "hydraulic torque over torque of the pump", default=0.9, above=0.0, at_most=1.0)
    drag: float = param("N m s/rad", "torque per speed of the pump without pressure", default=2e-3, at_least=0.0)
    pump_leakage: float = param("m3", "leakage per pressure, times the dynamic viscosity", default=2e-14, at_least=0.0)
    line_volume: float = param("m3", "oil in the line", default=2e-4, above=0.0)
    port_volume: float = param("m3", "oil between a valve and its piston", default=1e-5, above=0.0)
    regulator_area: float = param("m2", "area of the open regulator", default=6e-5, above=0.0)
    valve_area: float = param("m2", "area of an open spool valve", default=4e-5, above=0.0)
    valve_span: float = param("Pa", "pilot pressure that moves a spool to its end", default=2e4, above=0.0)
    transition: float = param(
        "1", "the flow in its spool valves becomes turbulent at this Reynolds number", default=260.0, above=0.0
    )
    overlap: float = param(
        "1", "share of the way of a spool that opens nothing", default=0.02, at_least=0.0, at_most=0.9
    )
    lag: float = param("s", "time constant of the pilot pressures", default=0.015, above=0.0)
    orifice_area: float = param("m2", "area of the bore before a piston", default=3e-6, above=0.0)
    preload: float = param("N", "force of a return spring at its stop", default=300.0, at_least=0.0)
    spring_rate: float = param("N/m", "stiffness of a return spring", default=1e5, above=0.0)
    kiss_stroke: float = param("m", "stroke at which plates touch", default=2e-3, above=0.0)
    contact_rate: float = param("N/m", "stiffness of plates", default=2e7, above=0.0)
    density: SignalLike = signal("kg/m3", 'density of the oil, as `(oil, "density")`', default=DENSITY, above=0.0)
    viscosity: SignalLike = signal(
        "m2/s", 'kinematic viscosity of the oil, as `(oil, "viscosity")`', default=VISCOSITY, above=0.0
    )

    def problems(self) -> Found:
        areas = self.piston_areas or {}
        if not areas:
            return [("piston_areas", "names no element", "give the area of each piston")]
        unknown = [name for name in self.pressures or {} if name not in areas]
        return [(f"pressures.{name}", "has no piston", "give its area too") for name in unknown]

    def parts(self) -> Iterable[Component]:
        """Line, pump and regulator, and of each element valve, oil and piston."""
        oil: dict[str, Any] = {"density": self.density, "viscosity": self.viscosity}
        start = command_at_start(self.line_pressure)
        line = OilVolume(f"{self.name}.line", volume=self.line_volume, initial_pressure=start)
        yield line
        pump: dict[str, Any] = {"displacement": self.displacement, "efficiency": self.efficiency, "drag": self.drag}
        leakage = self.pump_leakage
        yield Pump(f"{self.name}.pump", shaft=self.shaft, outlet=line, leakage=leakage, **pump, **oil)
        limit: dict[str, Any] = {"command": self.line_pressure, "area": self.regulator_area}
        yield ReliefValve(f"{self.name}.regulator", inlet=line, **limit, **oil)
        for name, area in (self.piston_areas or {}).items():
            yield from self._circuit(name, area, line, oil)

    def _circuit(self, name: str, area: float, line: OilVolume, oil: Mapping[str, Any]) -> Iterable[Component]:
        """Valve, oil and piston of an element."""
        held = float((self.pressures or {}).get(name, 0.0))
        oil_there = OilVolume(f"{self.name}.{name}_port", volume=self.port_volume, initial_pressure=held)
        yield oil_there
        yield SpoolValve(
            f"{self.name}.{name}_valve",
            supply=line,
            clutch=oil_there,
            command=held,
            supply_area=self.valve_area,
            exhaust_area=self.valve_area,
            span=self.valve_span,
            overlap=self.overlap,
            transition=self.transition,
            lag=self.lag,
            **oil,
        )
        yield ClutchActuator(
            f"{self.name}.{name}_piston",
            supply_pressure=oil_there,
            orifice_area=self.orifice_area,
            piston_area=area,
            preload=self.preload,
            spring_rate=self.spring_rate,
            kiss_stroke=self.kiss_stroke,
            contact_rate=self.contact_rate,
            initial_stroke=self._stroke(held * area),
        )

    def _stroke(self, force: float) -> float:
        """Stroke at which the springs balance a force of the oil."""
        alone = (force - self.preload) / self.spring_rate
        if alone <= self.kiss_stroke:
            return max(alone, 0.0)
        beyond = self.contact_rate * self.kiss_stroke
        return (force - self.preload + beyond) / (self.spring_rate + self.contact_rate)
