"""Python functions that are called at a period, read signals and set inputs."""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from dataclasses import field
from typing import TYPE_CHECKING, Any

from clutchwork.base import FMUError, dataclass
from clutchwork.run.trajectory import SimulationError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from clutchwork.assembly.records import Input
    from clutchwork.fmu_import.guests import Guests
    from clutchwork.results.channels import Channels
    from clutchwork.results.external_settings import Held


@dataclass(frozen=True)
class Controller:
    """A function f(t, readings) -> value that sets one input every period [s]."""

    name: str
    index: int
    period: float
    function: Callable[[float, Mapping[str, Any]], float]

    def value(self, time: float, readings: Mapping[str, Any]) -> float:
        """Call the function; what it raises or a value that is not finite ends the run with its name."""
        try:
            given = self.function(time, readings)
            value = math.nan if given is None else float(given)
        except FMUError as error:
            raise SimulationError(str(error)) from error
        except Exception as error:
            raise SimulationError(f"controller of {self.name!r} failed at {time:.9g} s: {error!r}") from error
        if not math.isfinite(value):
            words = f"controller of {self.name!r} returned {None if given is None else value} at {time:.9g} s"
            raise SimulationError(f"{words}: return a finite number")
        return value


def controllers(
    inputs: Sequence[Input], held: Container[str] = (), guests: Guests | None = None
) -> tuple[Controller, ...]:
    """The inputs of a System that Python functions set, without those that are held from outside.

    Parameters: guests, the FMUs of the run that asks them.
    """
    return tuple(
        Controller(item.name, index, sampling.period, guests.bound(sampling.function) if guests else sampling.function)
        for index, item in enumerate(inputs)
        if (sampling := item.signal.sampling()) is not None and item.name not in held
    )


def guests_of(inputs: Sequence[Input]) -> Guests | None:
    """The FMUs of other people that a run of a System needs, none of them started yet; None where no function is."""
    functions = [sampling.function for item in inputs if (sampling := item.signal.sampling()) is not None]
    if not functions:
        return None
    # loaded where functions set inputs
    from clutchwork.fmu_import.guests import Guests

    return Guests(functions)


def refuse_guests(inputs: Sequence[Input], held: Container[str] = ()) -> None:
    """StateError where FMUs set inputs of a System: no state of a run holds theirs."""
    # loaded where a run goes on from a state
    from clutchwork.fmu_import.output import Output
    from clutchwork.results.state import StateError

    names = [one.name for one in controllers(inputs, held) if isinstance(one.function, Output)]
    if names:
        why = "which begins at the start of a run, and no state of a run holds its own"
        raise StateError(f"{names[0]!r} is set by an FMU, {why}: run from the start, or set it to a number or a table")


Settings = list[tuple[int, float]]


@dataclass
class Control:
    """Calls the controllers at their instants, and remembers what they set so that a run can be repeated."""

    controllers: tuple[Controller, ...]
    channels: Callable[[], Channels]
    log: dict[float, Settings] = field(default_factory=dict)
    held: Held = field(default_factory=dict)  # from outside, since before the run
    changed: Mapping[str, Any] = field(default_factory=dict)
    first: NDArray[np.float64] | None = None  # the row that controllers see where a run goes on from a state

    def act(self, run: Any, time: float, number: int) -> bool:
        """Set the inputs that are due; False when there is nothing to do."""
        # what was set there is decided together with what controllers say
        given = self.first if number == 0 else None
        if time not in self.log:
            self.log[time] = self._decide(run, time, given)
        elif self.log[time] and given is None:
            # a repetition takes the same path through the core
            run.row()
        for index, value in self.log[time]:
            run.set_input(index, value)
        return bool(self.log[time])

    def _decide(self, run: Any, time: float, given: NDArray[np.float64] | None) -> Settings:
        due = [controller for controller in self.controllers if is_due(controller.period, time)]
        if not due:
            return []
        from clutchwork.run.readings import Readings

        readings = Readings(self.channels(), run.row() if given is None else given)
        return [(controller.index, controller.value(time, readings)) for controller in due]

    def stops(self, begin: float, t_end: float) -> Iterator[float]:
        """Instants up to which the core may run: those of all controllers, then the end [s]."""
        return instants(self.controllers, begin, t_end)

    def outside(self, number: int) -> tuple[Held, Mapping[str, Any]]:  # noqa: ARG002, they stay
        """Signals and parameters that are set from outside."""
        return self.held, self.changed

    def plain(self) -> None:
        """Functions are in no file; without them the model says all."""


def instants(given: Sequence[Controller], begin: float, t_end: float) -> Iterator[float]:
    """Instants of controllers after the begin and before the end, then the end [s]."""
    counts = [_first_after(begin, controller.period) for controller in given]
    while given:
        due = [count * controller.period for count, controller in zip(counts, given, strict=True)]
        first = min(due)
        if first >= t_end:
            break
        yield first
        counts = [n + (at <= first * (1 + 1e-12)) for n, at in zip(counts, due, strict=True)]
    yield t_end


def _first_after(time: float, period: float) -> int:
    """Number of the first multiple of a period after a time, one that is there within round-off left out."""
    return round(time / period) + 1 if is_due(period, time) else math.floor(time / period) + 1


def is_due(period: float, time: float) -> bool:
    """Whether a time is a multiple of a period, within round-off."""
    return abs(time - round(time / period) * period) <= 1e-12 * max(time, period)
