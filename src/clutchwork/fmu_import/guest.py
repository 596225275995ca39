"""An FMU that runs: begun at its first instant, stepped at all others."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import TYPE_CHECKING, Any

from clutchwork.base import FMUError, quote
from clutchwork.fmu_import.messages import Command
from clutchwork.fmu_import.process import Process

if TYPE_CHECKING:
    from clutchwork.fmu_import.fmu import FMU

# instants that lie a period apart within round-off, as a share of it
ROUND_OFF = 1e-6


class Guest:
    """An FMU that runs."""

    def __init__(self, fmu: FMU, names: list[str]) -> None:
        """Start its process."""
        self.fmu, self._names = fmu, names
        self._time = -float("inf")  # s, of the last instant
        self._given: list[float] = []  # inputs read there
        self._outputs: dict[str, float] = {}
        try:
            self.process = Process(fmu.path, fmu.assignment(names), fmu.time_limit)
        except FMUError as error:
            raise FMUError(f"FMU {quote(fmu.name)}: {error}") from None

    def outputs(self, time: float, readings: Mapping[str, Any]) -> dict[str, float]:
        """Outputs at an instant [s]: those of the step that ends there, from the inputs at its begin."""
        if time != self._time:
            if self.process.ended:
                raise self._failed("was interrupted before it had answered: start again", "")
            # all that an instant needs is read before anything is done
            given = [self._read(name, signal, time, readings) for name, signal in self.fmu.inputs.items()]
            if not self._outputs:
                self._ask(Command.BEGIN, time, given, f"at its start at {time:.9g} s")
            else:
                self._step(time)
            self._time, self._given = time, given
        return self._outputs

    def _step(self, time: float) -> None:
        """The step from the last instant to this one."""
        begin, period = self._time, self.fmu.period
        when = f"in its step from {begin:.9g} to {time:.9g} s"
        if abs(time - begin - period) > ROUND_OFF * period:
            why = "all of its outputs were set from outside, or the run went to another time"
            raise self._failed(f"was not asked {when}, which is not one period of {period:g} s: {why}", "")
        self._ask(Command.STEP, begin, self._given, when)

    def _ask(self, order: Command, time: float, given: list[float], when: str) -> None:
        try:
            found = self.process.ask(order, time, self.fmu.period, given)
        except FMUError as error:
            raise self._failed(str(error), when) from None
        self._outputs = {name: self._si(name, value, when) for name, value in zip(self._names, found, strict=True)}

    def _si(self, name: str, value: float, when: str) -> float:
        if not isfinite(value):
            raise self._failed(f"gave {value} as its output {quote(name)}", when)
        return self.fmu.variable(name).scale.si(value)

    def _read(self, name: str, signal: str, time: float, readings: Mapping[str, Any]) -> float:
        """An input in its unit."""
        try:
            value = readings[signal]
        except KeyError as error:
            raise self._failed(f"reads {quote(name)} from {quote(signal)}: {error}", "") from None
        if isinstance(value, str):
            raise self._failed(f"reads {quote(name)} from {quote(signal)}, which is {quote(value)}, not a number", "")
        scale = self.fmu.variable(name).scale
        number = (float(value) - scale.zero) / scale.factor
        if not isfinite(number):
            raise self._failed(f"reads {quote(name)} from {quote(signal)}, which is {value} at {time:.9g} s", "")
        return number

    def _failed(self, what: str, when: str) -> FMUError:
        return FMUError(f"FMU {quote(self.fmu.name)} {what}{f' {when}' if when else ''}")
