"""Electric motor."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property

from clutchwork.declare import (
    Component,
    Found,
    Node,
    Points,
    Role,
    SignalLike,
    ThermalNode,
    component,
    curve,
    numbers,
    option,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.grids import Grid, at_each, points_of, resampled, shape_problems, union
from clutchwork.elements.bases.heating import Heating
from clutchwork.elements.conduction import Conduction
from clutchwork.elements.motor_torque import MotorTorque

# speed [rad/s] or [m/s] over which a generator gets its torque, where it has more than the motor has at rest
NEAR_REST = 0.1


@component(Role.COMPOSITE)
class ElectricMotor(Heating):
    """Motor that follows a torque command within its envelope in all four quadrants, with its losses.

    Use it for traction motors, starters, generators and servo drives. The command first passes the lag and is then
    clipped, to `max_torque` and `max_power` while it drives, to those of the generator while it brakes; at rest it
    holds no more than it drives with. `electric_power` is what it draws, work and losses, and is negative while it
    charges. The losses are a polynomial, plus a map, or follow from a map of efficiencies; tables over abs(speed) and
    abs(torque) are held beyond their ends. They warm its `heat` node, or a `winding` of its own, whose temperature may
    derate it.
    """

    shaft: Node = port("shaft that a positive torque accelerates")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    command: SignalLike = signal("N m", "wanted torque", units=("N",))
    max_torque: Points | float = curve(
        "rad/s",
        "N m",
        "largest torque that drives, over abs(speed) or a number",
        units=("N",),
        units_x=("m/s",),
        at_least=0.0,
        constant=True,
    )
    max_power: float = param("W", "largest power that drives, no limit by default", default=1e15, above=0.0)
    generator_torque: Points | float | None = curve(
        "rad/s",
        "N m",
        "largest torque that brakes, as `max_torque` by default",
        units=("N",),
        units_x=("m/s",),
        at_least=0.0,
        constant=True,
        default=None,
    )
    generator_power: float | None = param(
        "W", "largest power that brakes, as `max_power` by default", default=None, above=0.0
    )
    lag: float = param("s", "time constant of the command, 0: it acts at once", default=0.0, at_least=0.0)
    initial_request: float = option("N m", "lagged command at the start", default=0.0, units=("N",))
    no_load_loss: float = param("W", "constant loss", default=0.0, at_least=0.0)
    drag_loss: float = param("W s/rad", "loss over abs(speed)", default=0.0, at_least=0.0, units=("W s/m",))
    iron_loss: float = param("W s2/rad2", "loss over speed^2", default=0.0, at_least=0.0, units=("W s2/m2",))
    copper_loss: float = param("W/(N2 m2)", "loss over torque^2", default=0.0, at_least=0.0, units=("W/N2",))
    speeds: Sequence[float] | None = numbers(
        "rad/s", "abs(speed) of the rows of the map", units=("m/s",), rising="strictly", at_least=0.0, default=None
    )
    torques: Sequence[float] | None = numbers(
        "N m", "abs(torque) of the columns of the map", units=("N",), rising="strictly", at_least=0.0, default=None
    )
    losses: Sequence[Sequence[float]] | None = numbers(
        "W", "map of losses, a row over the torques for each speed", at_least=0.0, default=None, rows=True
    )
    efficiencies: Sequence[Sequence[float]] | None = numbers(
        "1", "map of efficiencies, a row over the torques for each speed", above=0.0, default=None, rows=True
    )
    derating: Points | None = curve(
        "K",
        "1",
        "factor on all limits over the temperature",
        at_least=0.0,
        default=None,
        example=((290.0, 1.0), (400.0, 0.5)),
    )
    temperature: SignalLike | None = signal(
        "K", "temperature that derates it, that of its node by default", default=None, otherwise=293.15, example=300.0
    )
    thermal_mass: float | None = param("J/K", "heat capacity of a winding of its own", default=None, above=0.0)
    cooling: float = param("W/K", "conductance from that to the ambient", default=0.0, at_least=0.0)
    ambient: float = param("K", "temperature of that ambient", default=293.15, above=0.0)
    initial_temperature: float | None = option(
        "K", "of the winding at the start, as the ambient by default", default=None, above=0.0
    )

    def problems(self) -> Found:
        found: Found = []
        for name in ("max_torque", "generator_torque"):
            points = points_of(getattr(self, name) or 0.0)
            if points[0][0] < 0.0:
                found.append((name, f"starts at {points[0][0]:g}", "give it over abs(speed), from 0 on"))
        found += self._map_problems()
        if self.thermal_mass is not None and self.heat is not None:
            found.append(("heat", "cannot be given together with thermal_mass", "give one of them"))
        if self.cooling > 0.0 and self.thermal_mass is None:
            found.append(
                ("cooling", "needs a winding of its own", "give thermal_mass, or join its `heat` node by Conduction")
            )
        known = self.temperature is not None or self.heat is not None or self.thermal_mass is not None
        if self.derating is not None and not known:
            found.append(("derating", "has no temperature", "give thermal_mass, `heat` or `temperature`"))
        return found

    def _map_problems(self) -> Found:
        given = [name for name in ("losses", "efficiencies") if getattr(self, name) is not None]
        axes = [name for name in ("speeds", "torques") if getattr(self, name) is None]
        if len(given) == 2:
            return [("efficiencies", "cannot be given together with losses", "give one of them")]
        if given and axes:
            return [
                (given[0], f"needs {' and '.join(axes)}", "give the speeds of its rows and the torques of its columns")
            ]
        if not given:
            return [] if len(axes) == 2 else [("speeds", "belongs to a map", "give losses or efficiencies")]
        found = shape_problems(given[0], getattr(self, given[0]), self.speeds, self.torques)
        if not found and any(eta > 1.0 for row in self.efficiencies or () for eta in row):
            found.append(("efficiencies", "exceeds 1", "give losses where something else drives it"))
        return found

    @cached_property
    def winding(self) -> ThermalNode | None:
        """Node of its own thermal mass, to join to further flows of heat; none without one."""
        if self.thermal_mass is None:
            return None
        start = self.ambient if self.initial_temperature is None else self.initial_temperature
        return ThermalNode(f"{self.name}.winding", self.thermal_mass, start)

    def parts(self) -> Iterable[Component | ThermalNode]:
        """The torque, and what else was asked for."""
        winding = self.winding
        if winding is not None:
            yield winding
        yield self._torque(winding)
        if winding is not None and self.cooling > 0.0:
            around = ThermalNode(f"{self.name}.ambient", temperature=self.ambient)
            yield around
            yield Conduction(f"{self.name}.cooling", hot=winding, cold=around, conductance=self.cooling)

    def _torque(self, winding: ThermalNode | None) -> MotorTorque:
        drives = points_of(self.max_torque)
        brakes = drives if self.generator_torque is None else points_of(self.generator_torque)
        map_ = self.losses if self.losses is not None else self.efficiencies
        grid = Grid(self.speeds or (0.0,), self.torques or (0.0,), map_ or ((0.0,),))
        speeds = union([0.0], [x for x, _ in drives], [x for x, _ in brakes], grid.rows if map_ is not None else [])
        torques = union([0.0], grid.columns) if map_ is not None else (0.0,)
        motoring, generating = at_each(drives, speeds), at_each(brakes, speeds)
        if generating[0] > motoring[0]:
            speeds = union([NEAR_REST], speeds)
            motoring, generating = at_each(drives, speeds), at_each(brakes, speeds)
            generating = (motoring[0], *generating[1:])
        return MotorTorque(
            self.name,
            shaft=self.shaft,
            base=self.base,
            speeds=speeds,
            motoring=motoring,
            generating=generating,
            motor_power=self.max_power,
            generator_power=self.max_power if self.generator_power is None else self.generator_power,
            torques=torques,
            map=resampled(grid, speeds, torques),
            map_of="losses" if self.efficiencies is None else "efficiencies",
            no_load_loss=self.no_load_loss,
            drag_loss=self.drag_loss,
            iron_loss=self.iron_loss,
            copper_loss=self.copper_loss,
            derating=self.derating or ((300.0, 1.0),),
            scale=max(*motoring, *generating) or 1.0,
            command=self.command,
            temperature=self.temperature,
            lag=self.lag,
            initial_request=self.initial_request,
            heat=winding or self.heat,
            heat_share=self.heat_share,
        )
