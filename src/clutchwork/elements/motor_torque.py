"""Torque of an electric motor over grids of speeds and torques."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from clutchwork.declare import (
    Found,
    Node,
    Points,
    Role,
    SignalLike,
    State,
    Work,
    choice,
    component,
    curve,
    numbers,
    option,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.heating import Heating


@component(
    Role.TORQUE,
    states=(State("request", "N m", "command behind its lag"),),
    hooks=("edges", "edge", "margin", "cross", "turns", "settle", "heat", "count", "fits"),
)
class MotorTorque(Heating):
    """A command, clipped to what a motor can do at its speed and temperature, with its losses.

    Use it to build machines of your own; `ElectricMotor` makes its grids from the tables of a data sheet. All tables
    hold over the one grid of abs(speed), and are held beyond it.
    """

    work: ClassVar[Work] = Work.SOURCE
    supply: ClassVar[str] = "electric"

    shaft: Node = port("shaft that a positive torque accelerates")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    speeds: Sequence[float] = numbers(
        "rad/s", "grid of abs(speed), from 0", units=("m/s",), rising="strictly", at_least=0.0, example=(0.0, 5.0, 10.0)
    )
    motoring: Sequence[float] = numbers(
        "N m", "largest torque that drives, one for each speed", units=("N",), at_least=0.0, example=(5.0, 4.0, 1.0)
    )
    generating: Sequence[float] = numbers(
        "N m", "largest torque that brakes, one for each speed", units=("N",), at_least=0.0, example=(4.0, 4.0, 2.0)
    )
    motor_power: float = param("W", "largest power that drives, no limit by default", default=1e15, above=0.0)
    generator_power: float = param("W", "largest power that brakes, no limit by default", default=1e15, above=0.0)
    torques: Sequence[float] = numbers(
        "N m",
        "grid of abs(torque) of the map, from 0",
        units=("N",),
        rising="strictly",
        at_least=0.0,
        example=(0.0, 3.0),
    )
    map: Sequence[Sequence[float]] = numbers(
        "1",
        "map of losses [W] or efficiencies, a row over the torques for each speed",
        at_least=0.0,
        example=((0.0, 1.0), (1.0, 3.0), (2.0, 4.0)),
        rows=True,
    )
    map_of: str = choice("what the map holds", choices=("losses", "efficiencies"), default="losses")
    no_load_loss: float = param("W", "constant loss", default=0.0, at_least=0.0)
    drag_loss: float = param("W s/rad", "loss over abs(speed)", default=0.0, at_least=0.0, units=("W s/m",))
    iron_loss: float = param("W s2/rad2", "loss over speed^2", default=0.0, at_least=0.0, units=("W s2/m2",))
    copper_loss: float = param("W/(N2 m2)", "loss over torque^2", default=0.0, at_least=0.0, units=("W/N2",))
    derating: Points = curve(
        "K", "1", "factor on all limits over the temperature", at_least=0.0, example=((300.0, 1.0), (400.0, 0.5))
    )
    scale: float = param("N m", "torque that round-off is measured against", default=1.0, above=0.0, units=("N",))
    command: SignalLike = signal("N m", "wanted torque", units=("N",))
    temperature: SignalLike | None = signal(
        "K", "temperature that derates it, that of its `heat` node by default", default=None, otherwise=293.15
    )
    lag: float = param("s", "time constant of the command, 0: none", default=0.0, at_least=0.0, fixed=True, example=0.1)
    initial_request: float = option("N m", "lagged command at the start", default=0.0, units=("N",))

    def problems(self) -> Found:
        rows, columns = len(self.speeds), len(self.torques)
        found: Found = []
        for name, grid in (("speeds", self.speeds), ("torques", self.torques)):
            if grid[0] != 0.0:
                found.append((name, f"starts at {grid[0]:g}", "let it start at 0"))
        for name, values in (("motoring", self.motoring), ("generating", self.generating)):
            if len(values) != rows:
                found.append((name, f"has {len(values)} values for {rows} speeds", "give one for each speed"))
        if self.generating[0] > self.motoring[0]:
            fault = f"starts at {self.generating[0]:g} N m, above motoring with {self.motoring[0]:g} N m"
            found.append(("generating", fault, "give at rest no more than it drives with: there it could not stand"))
        if len(self.map) != rows or any(len(row) != columns for row in self.map):
            found.append(("map", f"must have {rows} rows of {columns} numbers", "give a row for each speed"))
        wrong = [share for row in self.map for share in row if not 0.0 < share <= 1.0]
        if self.map_of == "efficiencies" and wrong:
            found.append(("map", f"has the efficiency {wrong[0]:g}", "give efficiencies above 0 and up to 1"))
        return found

    def own_states(self) -> tuple[State, ...]:
        """The lagged command."""
        return self.states if self.lag > 0.0 else ()

    def initial_states(self) -> tuple[float, ...]:
        """That command at the start."""
        return (self.initial_request,) if self.lag > 0.0 else ()
