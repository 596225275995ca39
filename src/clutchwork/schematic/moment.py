"""The state of a run at one instant, as a schematic shows it."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from clutchwork.base import dataclass
from clutchwork.declare.schema import Role
from clutchwork.results.forms import LOCKED as LOCKED_MODE
from clutchwork.results.gears import NEUTRAL, gears_of
from clutchwork.results.recorded import Recorded
from clutchwork.schematic.diagram import Thing
from clutchwork.schematic.look import LOCKED, OPEN, SLIPPING
from clutchwork.schematic.values import number

NOTHING = 1e-9  # in SI units: what rounding leaves of zero


class Snapshot:
    """Nothing is known of a run: no states and no values."""

    time: float | None = None

    def state(self, thing: Thing) -> str:  # noqa: ARG002, there is no run
        """State of a contact: locked, slipping or open; empty for what has none."""
        return ""

    def parts(self, thing: Thing) -> frozenset[str]:  # noqa: ARG002
        """States of the parts of an element."""
        return frozenset()

    def node_lines(self, thing: Thing) -> list[str]:  # noqa: ARG002
        """What is written at a node."""
        return []

    def element_lines(self, thing: Thing) -> list[str]:  # noqa: ARG002
        """What is written at an element."""
        return []


@dataclass(frozen=True, eq=False)
class RunSnapshot(Snapshot):
    """One row of a run."""

    run: Recorded
    time: float
    row: int  # of the run
    power: bool = False

    @cached_property
    def _names(self) -> frozenset[str]:
        return frozenset(self.run.channels)

    def _value(self, name: str) -> float | None:
        return float(self.run.channels[name].evaluate(self.run.rows[[self.row]])[0]) if name in self._names else None

    def state(self, thing: Thing) -> str:
        """State of a contact: locked, slipping or open; empty for what has none."""
        if thing.source.role in (Role.FLOW, Role.PROCESS, Role.GEAR):
            return ""
        own = self._state_of(str(thing.source.name), thing.source)
        if own:
            return own
        found = {state for _, state in self._part_states(thing)}
        return next((state for state in (LOCKED, SLIPPING, OPEN) if state in found), "")

    def parts(self, thing: Thing) -> frozenset[str]:
        """States of the parts of an element, such as "forward:locked"."""
        sides = {*thing.pins, *thing.fixed}
        found = self._part_states(thing) if thing.source.role is Role.COMPOSITE else []
        return frozenset(f"{side}:{state}" for side in sides for name, state in found if name.startswith(f"{side}_"))

    def _part_states(self, thing: Thing) -> list[tuple[str, str]]:
        if thing.source.role is not Role.COMPOSITE:
            return []
        start = f"{thing.source.name}."
        parts = [part for part in thing.source.parts() if str(part.name).startswith(start)]
        found = [(str(part.name)[len(start) :], self._state_of(str(part.name), part)) for part in parts]
        return [(name, state) for name, state in found if state]

    def _state_of(self, name: str, component: Any) -> str:
        mode = self._value(f"{name}.mode")
        if mode is not None:
            if mode == LOCKED_MODE:
                return LOCKED
            return SLIPPING if abs(mode) == 1.0 and self._value(f"{name}.torque") else OPEN
        sleeve = self._value(f"{name}.sleeve")
        if sleeve is not None:
            return LOCKED if sleeve > component.reach else OPEN
        return ""

    def node_lines(self, thing: Thing) -> list[str]:
        """Speed of a shaft, temperature of a thermal node, pressure of oil."""
        name = str(getattr(thing.source, "name", ""))
        for signal in ("speed", "temperature", "pressure"):
            value = self._value(f"{name}.{signal}")
            if value is not None:
                return [self._shown(f"{name}.{signal}", value)]
        return []

    def element_lines(self, thing: Thing) -> list[str]:
        """Torque or force of an element, its slip while it has any, the heat of a flow, the state of a process."""
        name, lines = str(thing.source.name), list[str]()
        if thing.source.role is Role.PROCESS:
            states = [f"{name}.{state.name}" for state in thing.source.states[:1]]
            return [
                self._shown(signal, value) for signal in states for value in [self._value(signal)] if value is not None
            ]
        for signal in ("torque", "slip", *(("power",) if self.power else ())):
            value = self._value(f"{name}.{signal}")
            # an open contact has its slip alone
            if value is not None and (value or (signal == "torque" and self.state(thing) != OPEN)):
                lines.append(("slip " if signal == "slip" else "") + self._shown(f"{name}.{signal}", value))
        if any(table.name == name for table in self.run.system.gearboxes):
            gear = gears_of(self.run, name).at(self.time)
            lines.append("between gears" if gear is None else gear if gear == NEUTRAL else f"gear {gear}")
        flow = self._value(f"{name}.heat_flow") if thing.source.role is Role.FLOW else None
        return [*lines, *([self._shown(f"{name}.heat_flow", flow)] if flow is not None else [])]

    def _shown(self, signal: str, value: float) -> str:
        value = value if abs(value) > NOTHING else 0.0
        return number(
            float(np.format_float_positional(value, 4, fractional=False)) if value else 0.0, self.run.units[signal]
        )


def instant(run: Recorded, at: float, *, power: bool = False) -> RunSnapshot:
    """The instant `at` [s] of a run; the run is repeated for it where it was not recorded."""
    there = np.flatnonzero(run.time == at)
    # an instant that was recorded twice has the values after its event last
    if not len(there) and run.finished:
        run = run.at([at])
        there = np.array([len(run) - 1])
    if not len(there):
        there = np.array([int(np.argmin(np.abs(run.time - at)))])
    return RunSnapshot(run, at, int(there[-1]), power)
