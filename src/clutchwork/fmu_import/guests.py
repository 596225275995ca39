"""The FMUs of one run: each is begun where it is first asked, steps at its instants, and goes with the run."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from clutchwork.base import FMUError, quote
from clutchwork.fmu_import.output import Output

if TYPE_CHECKING:
    from clutchwork.fmu_import.fmu import FMU
    from clutchwork.fmu_import.guest import Guest

Function = Callable[[float, Mapping[str, Any]], float]


class Guests:
    """The FMUs of one run, by the functions that set its inputs."""

    def __init__(self, functions: Iterable[Function] = ()) -> None:
        """Make ready for those among functions that are outputs of FMUs; nothing is started yet."""
        self._names: dict[FMU, list[str]] = {}
        self._open: dict[FMU, Guest] = {}
        for one in functions:
            if isinstance(one, Output) and one.name not in self._names.setdefault(one.fmu, []):
                self._names[one.fmu].append(one.name)

    def bound(self, function: Function) -> Function:
        """A function for this run: an output asks the FMU that runs here, any other is itself."""
        return partial(self._value, function) if isinstance(function, Output) else function

    def renew(self) -> None:
        """End all of them; they begin anew where they are asked again."""
        for guest in self._open.values():
            guest.process.close()
        self._open.clear()

    def close(self) -> None:
        """End all of them, as their run has ended."""
        self.renew()
        self._names.clear()

    def _value(self, output: Output, time: float, readings: Mapping[str, Any]) -> float:
        fmu: FMU = output.fmu
        if fmu not in self._names:
            raise FMUError(f"FMU {quote(fmu.name)} has ended with its run: simulate again to go on")
        if fmu not in self._open:
            # loaded where an FMU runs
            from clutchwork.fmu_import.guest import Guest

            self._open[fmu] = Guest(fmu, self._names[fmu])
        return self._open[fmu].outputs(time, readings)[output.name]

    def __reduce__(self) -> tuple[type[Guests], tuple[()]]:
        """A copy has none of the processes."""
        return Guests, ()
