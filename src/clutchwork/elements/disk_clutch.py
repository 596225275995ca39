"""Disc friction clutch."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property

from clutchwork.declare import (
    Component,
    HeatFlow,
    Law,
    Node,
    Role,
    SignalLike,
    ThermalNode,
    choice,
    component,
    law,
    option,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.contacts import Contact
from clutchwork.elements.bases.geometry import Found, derating_when_worn, effective_radius, ring_problems
from clutchwork.elements.bases.plates import fault_problems, trigger
from clutchwork.elements.damper import Damper
from clutchwork.elements.one_way_clutch import OneWayClutch
from clutchwork.elements.plate_contact import PlateContact
from clutchwork.elements.wear import Wear
from clutchwork.laws.coulomb import Coulomb


@component(Role.COMPOSITE)
class DiskClutch(Contact):
    """Clutch with friction discs between two shafts, closed by a pressure or a normal force.

    Capacity is `coefficient * derating * surfaces * radius * (pressure - threshold) * area`, with the effective radius
    given or that of a ring; a normal force stands for pressure times area. Viscous drag acts always. A
    unidirectional clutch has a freewheel in parallel: it slips only forward. Use it for plate clutches, wet and dry,
    with any friction law.

    Its heat goes to a thermal mass of its own, `plates`, or to the node `heat`; laws that ask for a temperature take
    it from there. A fault is triggered at a time, by a signal above 0.5, or both, and stays. Wear, off by default,
    grows with the energy of sliding, lowers the derating of a ring to that of uniform wear, and raises the threshold.

    Equations: docs/theory/clutches.md.
    """

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side whose motion is positive: slip = follower - base")
    friction: Law = law(
        "friction coefficient over slip, static coefficient at rest", default=Coulomb(static=0.35, kinetic=0.3)
    )
    radius: float | None = param("m", "effective radius, in place of the diameters", default=None, above=0.0)
    outer_diameter: float | None = param("m", "outer diameter of the ring", default=None, above=0.0)
    inner_diameter: float | None = param("m", "inner diameter of the ring", default=None, at_least=0.0)
    surfaces: int = param("1", "number of friction surfaces", default=4, above=0.0, whole=True)
    area: float | None = param(
        "m2", "area that the pressure acts on, and that wears", default=None, above=0.0, example=1e-3
    )
    derating: float = param("1", "factor on the capacity: 1 new, less when worn", default=1.0, above=0.0)
    threshold: float = param(
        "Pa", "pressure, or force in N, up to which it stays open", default=0.0, at_least=0.0, units=("N",)
    )
    pressure: SignalLike | None = signal(
        "Pa", "pressure on the piston; below zero counts as zero", default=None, presses=True
    )
    normal_force: SignalLike | None = signal(
        "N", "force on the discs", default=None, instead_of="pressure", presses=True
    )
    drag: float = param("N m s/rad", "viscous drag coefficient", default=0.0, at_least=0.0)
    direction: str = choice(
        "slips in both directions, or only forward",
        choices=("bidirectional", "unidirectional"),
        default="bidirectional",
    )
    tolerance: float = option(
        "rad/s", "slip below which it may lock; 0: at exactly zero", default=1e-3, at_least=0.0, last=1
    )
    thermal_mass: float | None = param("J/K", "heat capacity of the clutch, none by default", default=None, above=0.0)
    initial_temperature: float = param("K", "temperature of the thermal mass at the start", default=300.0, above=0.0)
    temperature_limit: float | None = param(
        "K", "highest temperature that its lining stands, which hints compare with", default=None, above=0.0
    )
    fault: str = choice(
        "what fails: nothing, it opens permanently, or it stays locked once it has locked",
        choices=("none", "cannot_transmit", "cannot_unlock"),
        default="none",
    )
    fault_time: float | None = param("s", "time that triggers the fault", default=None, at_least=0.0)
    fault_signal: SignalLike | None = signal("1", "triggers the fault above 0.5", default=None, otherwise=0.0)
    report: str = choice(
        "effect of a fault: an event, a warning as well, or the end of the run",
        choices=("none", "warning", "error"),
        default="warning",
    )
    wear_rate: float | None = param("m3/J", "worn volume per sliding energy, none by default", default=None, above=0.0)
    running_in: float = param(
        "m", "depth of wear over which the derating approaches that of uniform wear, by 1/e", default=1e-4, above=0.0
    )
    touch_shift: float = param("Pa/m", "rise of the threshold with wear", default=0.0, at_least=0.0, units=("N/m",))

    def problems(self) -> Found:
        found = ring_problems(self.radius, self.outer_diameter, self.inner_diameter)
        if self.area is None and (self.pressure is not None or self.wear_rate is not None):
            beside = "a pressure" if self.pressure is not None else "wear_rate"
            found.append(("area", f"is missing beside {beside}", "give the area of the piston in m2"))
        found += fault_problems(self.fault, self.fault_time, self.fault_signal)
        if self.thermal_mass is not None and self.heat is not None:
            found.append(
                (
                    "heat",
                    "cannot be given together with thermal_mass",
                    "give one of them; `plates` is the node of the own mass",
                )
            )
        if self.temperature_limit is not None and self.thermal_mass is None:
            found.append(
                (
                    "temperature_limit",
                    "needs a temperature of its own",
                    "give thermal_mass, or the limit of the heat node",
                )
            )
        return found

    @cached_property
    def plates(self) -> ThermalNode | None:
        """Node of its own thermal mass, to join to flows of heat; none without one."""
        if self.thermal_mass is None:
            return None
        return ThermalNode(f"{self.name}.plates", self.thermal_mass, self.initial_temperature, self.temperature_limit)

    @property
    def effective_radius(self) -> float:
        """Radius at which the friction acts [m], of a new ring or as given."""
        return effective_radius(self.radius, self.outer_diameter, self.inner_diameter)

    @property
    def gain(self) -> float:
        """Torque per unit of pressure [m3] or of force [m] and coefficient."""
        area = 1.0 if self.pressure is None else self.area or 1.0
        return self.derating * self.surfaces * self.effective_radius * area

    def parts(self) -> Iterable[Component | ThermalNode]:
        """The contact, and what else was asked for."""
        heat = self.plates or self.heat
        if self.plates is not None:
            yield self.plates
        wear = self._wear()
        yield PlateContact(
            self.name,
            base=self.base,
            follower=self.follower,
            friction=self.friction,
            gain=self.gain,
            threshold=self.threshold,
            worn=derating_when_worn(self.outer_diameter, self.inner_diameter),
            running_in=self.running_in,
            touch_shift=self.touch_shift,
            fault=self.fault,
            report=self.report,
            pressure=self.pressure,
            normal_force=self.normal_force,
            wear=wear,
            fault_signal=self.fault_signal,
            fault_time=trigger(self.fault_time),
            tolerance=self.tolerance,
            locked=self.locked,
            heat=heat,
            heat_share=self.heat_share,
        )
        if wear is not None:
            yield wear
        base, follower = self.base, self.follower
        if self.drag > 0.0:
            yield Damper(
                f"{self.name}.drag",
                base=base,
                follower=follower,
                damping=self.drag,
                heat=heat,
                heat_share=self.heat_share,
            )
        if self.direction == "unidirectional":
            yield OneWayClutch(f"{self.name}.freewheel", base=base, follower=follower, locked=self.locked)

    def _wear(self) -> Wear | None:
        if self.wear_rate is None:
            return None
        area = (self.area or 1.0) * self.surfaces
        return Wear(f"{self.name}.wear", rate=self.wear_rate, area=area, heat=HeatFlow(self))

    def sums(self) -> tuple[str, ...]:
        """What its torque, power and heat hold besides those of the contact."""
        return ("drag", "freewheel")
