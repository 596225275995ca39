"""Fill tests: what valves and pistons before the shift elements of a driveline do, measured at its model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import wiring
from clutchwork.base import UseError, listed
from clutchwork.declare import Component
from clutchwork.declare.schema import specs
from clutchwork.elements.pressure_actuator import PressureActuator
from clutchwork.elements.pressure_valve import PressureValve
from clutchwork.elements.spool_valve import SpoolValve
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.shifts.actuators import ElementActuator
from clutchwork.shifts.driver import TOUCH
from clutchwork.stepping.simulator import Simulator

FULL = 1e6  # Pa, of a command that is a pressure
# s: until a piston is empty, on each step of the stair, behind a pulse, and between two looks
EMPTY, STAIR, BEHIND, LOOK = 1.5, 0.25, 0.15, 1e-3
STEPS = 40
# halvings of the longest pulse [s]: to 0.1 ms
HALVINGS, LONGEST = 12, 0.5
# of what is held behind the pulse: more than this is too long a pulse
OVER = 1.5

Limits = Mapping[str, tuple[float, float]]


def fill_test(
    system: System, box: Gearbox, prefix: str = "gearbox", *, limits: Limits | None = None
) -> dict[str, ElementActuator]:
    """Measure how the clutches and brakes of a gearbox are actuated, by element; those pressed directly are left out.

    Use it for a plant whose pressures come out of valves and pistons; `cw.shifts.plant_of` does. Every command goes
    down a stair for torques over commands; then pulses of the full command and a small one behind them show the longest
    pulse after which an element only touches: its fill time. A step from there shows the lag.

    Parameters: limits, commands of the empty piston and of full torque by signal; by default those of the table of a
    valve, and 0 and 1 MPa above the spring of a piston. UseError where the commands make no torque.
    """
    found = {e.name: _command(system, f"{prefix}.{e.name}") for e in box.elements if e.kind in ("clutch", "brake")}
    found = {name: one for name, one in found.items() if one is not None}
    if not found:
        return {}
    test = _Test(system, prefix, {name: _limits(one, limits or {}) for name, one in found.items() if one})
    return test.actuators()


def _command(system: System, element: str) -> tuple[str, Component] | None:
    """Signal at the head of what presses an element, and the part whose signal it is; None: it is pressed directly."""
    contact = next((one.component for one in wiring(system).contacts if one.name == element), None)
    given = [getattr(contact, name, None) for name in ("pressure", "normal_force")]
    part = next((one for one in given if isinstance(one, Component)), None)
    if part is None:
        return None
    while True:
        part = _valve(system, part) if part.gathers else part
        # ports for oil are no commands
        inputs = [(item.name, getattr(part, item.name)) for item, spec in specs(type(part), "signal")]
        ports = {item.name for item, spec in specs(type(part), "signal") if spec.draws}
        commands = [
            (name, value) for name, value in inputs if name not in ports and name not in ("density", "viscosity")
        ]
        inner = next((value for _, value in commands or inputs if isinstance(value, Component)), None)
        if inner is None:
            return f"{part.name}.{(commands or inputs)[0][0]}", part
        part = inner


def _valve(system: System, oil: Component) -> Component:
    """The spool valve that fills a volume of oil; the volume itself where there is none."""
    valves = (one for one in system.processes if isinstance(one, SpoolValve))
    return next((one for one in valves if isinstance(one.clutch, Component) and one.clutch.name == oil.name), oil)


def _limits(found: tuple[str, Component], limits: Limits) -> tuple[str, float, float]:
    signal, part = found
    if signal in limits:
        return (signal, *limits[signal])
    if isinstance(part, PressureValve):
        points = sorted(part.pressure, key=lambda point: float(point[1]))
        return signal, float(points[0][0]), float(points[-1][0])
    return signal, 0.0, FULL + (part.spring if isinstance(part, PressureActuator) else 0.0)


class _Test:
    """All elements at once: what the vehicle does meanwhile is of no interest."""

    def __init__(self, system: System, prefix: str, ends: Mapping[str, tuple[str, float, float]]) -> None:
        self.ends, self.names = ends, list(ends)
        self.capacities = [f"{prefix}.{name}.capacity" for name in self.names]
        # the largest fraction of the capacity that slides
        self.sliding = np.array([_sliding(system, f"{prefix}.{name}") for name in self.names])
        self.sim = Simulator(system)
        # one at a time where they share a pump
        shared = any(type(process).gathers for process in system.processes)
        self.groups = [[name] for name in self.names] if shared else [self.names]
        self._set({name: self._at(name, 0.0) for name in self.names})
        self.sim.advance(EMPTY)
        self.empty = self.sim.save()

    def actuators(self) -> dict[str, ElementActuator]:
        shares, torques = self._stair()
        flat = [name for name, most in zip(self.names, torques[-1], strict=True) if most <= 0.0]
        if flat:
            raise UseError("cw.shifts.fill_test", [f"no command closes {listed(flat)}; give `limits` of their signals"])
        made = {}
        for name, column in zip(self.names, torques.T, strict=True):
            commands = tuple(self._at(name, share) for share in shares)
            made[name] = ElementActuator(
                self.ends[name][0], commands, tuple(column.tolist()), 0.0, self._kiss(name, shares, column), 0.0
            )
        times = self._fill_times(made)
        lags = self._lags(made, times)
        return {
            name: ElementActuator(one.signal, one.commands, one.torques, times[name], one.kiss, lags[name])
            for name, one in made.items()
        }

    def _set(self, commands: Mapping[str, float]) -> None:
        self.sim.set({self.ends[name][0]: value for name, value in commands.items()})

    def _at(self, name: str, share: float) -> float:
        _, low, high = self.ends[name]
        return low + share * (high - low)

    def _torques(self) -> Any:
        return np.asarray(self.sim[self.capacities]) * self.sliding

    def _stair(self) -> tuple[Any, Any]:
        shares, rows = np.linspace(0.0, 1.0, STEPS + 1).tolist(), []
        # downward, for on the way up a piston fills slowly at low commands
        for share in shares[::-1]:
            self._set({name: self._at(name, float(share)) for name in self.names})
            self.sim.advance(STAIR)
            rows.append(self._torques())
        return shares, np.maximum.accumulate(np.array(rows[::-1]), axis=0)

    def _kiss(self, name: str, shares: Any, torques: Any) -> float:
        """Where the straight line through the first torques begins."""
        first = int(np.flatnonzero(torques > 0.0)[0])
        last = min(first + 1, len(shares) - 1)
        slope = (torques[last] - torques[first]) / (shares[last] - shares[first]) if last > first else 0.0
        share = shares[first] - torques[first] / slope if slope else shares[first]
        return self._at(name, float(max(share, shares[max(first - 1, 0)])))

    def _fill_times(self, made: Mapping[str, ElementActuator]) -> dict[str, float]:
        """The longest pulses behind which the elements only touch."""
        return {name: time for names in self.groups for name, time in self._longest(made, names).items()}

    def _longest(self, made: Mapping[str, ElementActuator], names: Sequence[str]) -> dict[str, float]:
        low, high = dict.fromkeys(names, 0.0), dict.fromkeys(names, LONGEST)
        for _ in range(HALVINGS):
            tried = {name: 0.5 * (low[name] + high[name]) for name in names}
            peaks = self._pulse(made, tried)
            for name, peak in peaks.items():
                (high if peak > OVER * TOUCH * made[name].most else low)[name] = tried[name]
        return low

    def _pulse(self, made: Mapping[str, ElementActuator], times: Mapping[str, float]) -> dict[str, float]:
        """Largest torque during a pulse of the full command, and behind it."""
        self.sim.restore(self.empty)
        begin, most = self.sim.time, np.zeros(len(self.names))
        self._set({name: made[name].commands[-1] for name in times})
        ends = sorted((time, name) for name, time in times.items())
        for time, name in [*ends, (ends[-1][0] + BEHIND, "")]:
            while self.sim.time < begin + time - 1e-12:
                self.sim.advance(min(LOOK * 5.0, begin + time - self.sim.time))
                most = np.maximum(most, self._torques())
            if name:
                self._set({name: made[name].command(TOUCH * made[name].most)})
        return {name: most for name, most in zip(self.names, most.tolist(), strict=True) if name in times}

    def _lags(self, made: Mapping[str, ElementActuator], times: Mapping[str, float]) -> dict[str, float]:
        """Time to 63 % of a step up to half of the torque, from where the elements touch."""
        return {name: lag for names in self.groups for name, lag in self._lagging(made, times, names).items()}

    def _lagging(
        self, made: Mapping[str, ElementActuator], times: Mapping[str, float], names: Sequence[str]
    ) -> dict[str, float]:
        self._pulse(made, {name: times[name] for name in names})
        self.sim.advance(BEHIND)
        first, begin, found = self._torques(), self.sim.time, dict[str, float]()
        self._set({name: made[name].command(0.5 * made[name].most) for name in names})
        while len(found) < len(names) and self.sim.time < begin + LONGEST:
            self.sim.advance(LOOK)
            for name, start, value in zip(self.names, first, self._torques(), strict=True):
                waited = name in names and name not in found
                if waited and value - start > 0.632 * (0.5 * made[name].most - start):
                    found[name] = self.sim.time - begin
        return {name: found.get(name, LONGEST) for name in names}


def _sliding(system: System, element: str) -> float:
    """Coefficient while it slips slowly over the one at rest."""
    law = next((one.component.friction for one in wiring(system).contacts if one.name == element), None)
    static, kinetic = getattr(law, "static", None), law.sliding() if law is not None else None
    return kinetic / static if isinstance(static, int | float) and kinetic else 1.0
