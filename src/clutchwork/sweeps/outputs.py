"""What a sweep keeps of each variant: signals at the end or at instants, extremes, integrals, times of events.

Each output is asked for by name before the runs, and is also a function of a run: `cw.maximum("shaft.torque").of(run)`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError, listed, near, quote
from clutchwork.base.mistakes import Mistakes
from clutchwork.declare.calls import explained
from clutchwork.declare.options import instants
from clutchwork.results.felt import WINDOW, felt_jerk
from clutchwork.sweeps import parts
from clutchwork.sweeps.numbers import number as plain_number
from clutchwork.sweeps.numbers import pair

if TYPE_CHECKING:
    from clutchwork.results.events import Event
    from clutchwork.run.trajectory import Trajectory

Array = NDArray[Any]

# what an integral over time is kept as
INTEGRALS = {"power": "work", "speed": "angle", "acceleration": "speed"}
ON_MASSES = {"speed": "position"}
# a jump of the acceleration is a triangle of the jerk, two windows wide; its peak lies between two instants and is
# missed by half a step over the window at most, 3 %
PER_WINDOW = 16
# what may be meant for the jerk of a shaft, which is no signal
JERK_OF = re.compile(r"(.+)\.jerk|jerk\((.+)\)")


@dataclass(frozen=True)
class AtEnd:
    """A signal at the end time."""

    signal: str

    @property
    def name(self) -> str:
        """What a table calls it."""
        return self.signal

    def of(self, run: Trajectory) -> Any:
        """Its value in a run; NaN where the run did not finish."""
        return run[self.signal][-1].item() if run.finished else _missing(run, self.signal)


@dataclass(frozen=True)
class AtTimes:
    """A signal at instants."""

    signal: str
    times: tuple[float, ...]

    @property
    def name(self) -> str:
        """What a table calls it."""
        return f"{self.signal} at"

    def of(self, run: Trajectory) -> Array:
        """Its values in a run, NaN at instants that it did not reach."""
        there = run.at(self.times)
        values = there[self.signal]
        found = np.full(len(self.times), _missing(run, self.signal), dtype=values.dtype)
        found[: len(there)] = values
        return found


@dataclass(frozen=True)
class Extreme:
    """Largest or smallest value of a signal over the steps of the solver, each cut into equal parts."""

    signal: str
    kind: str  # maximum, minimum or peak: the one that is further from zero, without its sign

    @property
    def name(self) -> str:
        """What a table calls it."""
        return f"{self.kind}({self.signal})"

    def of(self, run: Trajectory) -> Any:
        """Its value in a run up to where that came, from the rows of `run` as they are."""
        return self.reduced(run[self.signal], np.zeros(1, np.intp))[0].item() if len(run) else np.nan

    def reduced(self, values: Array, starts: Array) -> Array:
        """Its value in each stretch of rows that begins at one of the starts."""
        if self.kind == "minimum":
            return np.minimum.reduceat(values, starts)
        return np.maximum.reduceat(np.abs(values) if self.kind == "peak" else values, starts)


@dataclass(frozen=True)
class Integral:
    """A power, speed or acceleration over the whole run: the work, angle or speed that the solver integrated."""

    signal: str

    @property
    def name(self) -> str:
        """What a table calls it."""
        return f"integral({self.signal})"

    def kept_as(self, names: Any) -> str:
        """The signal whose change it is, empty where there is none."""
        owner, _, last = self.signal.rpartition(".")
        drawn = f"{last.removesuffix('_power')}_energy" if last.endswith("_power") else ""
        found = (f"{owner}.{word}" for word in (INTEGRALS.get(last), ON_MASSES.get(last), drawn) if word)
        return next((name for name in found if name in names), "")

    def of(self, run: Trajectory) -> Any:
        """Its value in a run; NaN where the run did not finish."""
        values = run.at([run.options.t_start, run.t_end])[self.kept_as(run)]
        return (values[-1] - values[0]).item() if run.finished else np.nan


@dataclass(frozen=True)
class SquaredJerk:
    """The integral of the square of the jerk of a shaft or a mass over the steps of the solver."""

    shaft: str

    @property
    def name(self) -> str:
        """What a table calls it."""
        return f"squared_jerk({self.shaft})"

    @property
    def signal(self) -> str:
        """The signal whose rate is squared."""
        return f"{self.shaft}.acceleration"

    def of(self, run: Trajectory) -> float:
        """Its value in a run; NaN where the run did not finish."""
        if not run.finished:
            return float("nan")
        times, begins = parts.in_parts(run.repeat(None).time)
        there = run.at(times)
        return parts.squared_jerk(there.time, there[self.signal], begins)


@dataclass(frozen=True)
class FeltJerk:
    """The largest jerk of a shaft or a mass, averaged over windows: second differences of its speed."""

    shaft: str
    window: float  # s
    between: tuple[float, float] | None = None  # s

    @property
    def name(self) -> str:
        """What a table calls it."""
        return f"jerk({self.shaft})"

    @property
    def signal(self) -> str:
        """The signal whose second difference it is."""
        return f"{self.shaft}.speed"

    def inside(self, begin: float, end: float) -> tuple[float, float]:
        """The part of a run that counts [s]."""
        first, last = self.between or (begin, end)
        return max(first, begin), min(last, end)

    def is_too_long(self, begin: float, end: float) -> bool:
        """Whether a run has no two windows."""
        first, last = self.inside(begin, end)
        return last - first < 2.0 * self.window * (1.0 - 1e-9)

    def faults(self, begin: float, end: float) -> list[str]:
        """Why there is no window in a run."""
        if not self.is_too_long(begin, end):
            return []
        first, last = self.inside(begin, end)
        takes = f"two windows of {self.window:g} s take {2.0 * self.window:g} s"
        have = f"there are {max(last - first, 0.0):g} s of the run"
        return [f"{self.name}: {takes}, {have}; give a window= or between= that fits, or a longer run"]

    def times(self, begin: float, end: float) -> Array:
        """Instants a small part of a window apart, at which a run gives the speed [s]; none if it is too short."""
        (first, last), step = self.inside(begin, end), self.window / PER_WINDOW
        count = -1 if self.is_too_long(begin, end) else int((last - first) / step * (1.0 + 1e-12))
        found: Array = np.minimum(first + step * np.arange(count + 1), last)
        return found

    def felt(self, speeds: Array) -> Array:
        """The jerk from speeds at these instants, with its sign: docs/theory/jerk.md (1)."""
        return felt_jerk(speeds, self.window, PER_WINDOW)

    def largest(self, speeds: Array) -> Array:
        """The largest magnitude of each line of speeds, NaN where there is none."""
        if speeds.shape[-1] <= 2 * PER_WINDOW:
            return np.full(speeds.shape[:-1], np.nan)
        return np.asarray(np.abs(self.felt(speeds.T)).max(axis=0))

    def of(self, run: Trajectory) -> float:
        """Its value in a run; NaN where the run did not finish."""
        times = self.times(run.options.t_start, run.t_end)
        return float(self.largest(run.at(times)[self.signal])) if run.finished and len(times) else float("nan")


@dataclass(frozen=True)
class When:
    """Time at which a contact locks or breaks away, counted from the start, or with -1 from the end."""

    contact: str
    kind: str  # lock or break_away
    number: int = 1

    @property
    def name(self) -> str:
        """What a table calls it."""
        return f"{self.kind}({self.contact})" if self.number == 1 else f"{self.kind}({self.contact}, {self.number})"

    def of(self, run: Trajectory) -> float:
        """Its value in a run; NaN where that did not happen."""
        times = [event.time for event in run.events.of(self.contact) if self.fits(event)]
        place = self.number - 1 if self.number > 0 else len(times) + self.number
        return times[place] if 0 <= place < len(times) else float("nan")

    def fits(self, event: Event) -> bool:
        """Whether an event is one of those that are counted."""
        from_locked, to_locked = event.before == "locked", event.after == "locked"
        return from_locked != to_locked and to_locked == (self.kind == "lock")


@dataclass(frozen=True)
class Computed:
    """The result of a Python function of a run."""

    function: Callable[[Trajectory], Any]
    name: str

    def of(self, run: Trajectory) -> Any:
        """Its value."""
        return self.function(run)

    def one(self, value: Any) -> Any:
        """The value where it is a single one; UseError for any other."""
        if isinstance(value, list | tuple | set | dict) or getattr(value, "ndim", None):
            remedy = "give one number for each variant; cw.at(signal, times) gives a signal at several instants"
            raise UseError("sweep", [f"the output {self.name!r} gave {quote(value)}: {remedy}"])
        return value.item() if getattr(value, "shape", None) == () else value


Output: TypeAlias = AtEnd | AtTimes | Extreme | FeltJerk | Integral | SquaredJerk | When | Computed
Asked: TypeAlias = "str | Output | Callable[[Trajectory], Any]"


@explained("cw.at")
def at(signal: str, times: Sequence[float] | float) -> AtTimes:
    """A signal at instants, for `sweep`.

    Parameters: signal, its name; times [s], one or several that rise.
    """
    named("at", signal)
    plain = instants(times)
    try:
        found = tuple(float(time) for time in np.atleast_1d(np.asarray(plain, dtype=float)))
    except (TypeError, ValueError):
        found = ()
    if not found or not all(0.0 <= time < np.inf for time in found) or list(found) != sorted(found):
        raise UseError("at", [f"times are {quote(times)}: give instants [s] from zero on that rise"])
    return AtTimes(signal, found)


@explained("cw.maximum")
def maximum(signal: str) -> Extreme:
    """The largest value of a signal, for `sweep`."""
    return Extreme(named("maximum", signal), "maximum")


@explained("cw.minimum")
def minimum(signal: str) -> Extreme:
    """The smallest value of a signal, for `sweep`."""
    return Extreme(named("minimum", signal), "minimum")


@explained("cw.peak")
def peak(signal: str) -> Extreme:
    """The largest absolute value of a signal, for `sweep`."""
    return Extreme(named("peak", signal), "peak")


@explained("cw.integral")
def integral(signal: str) -> Integral:
    """The integral over time of a power, a speed or an acceleration, for `sweep`."""
    return Integral(named("integral", signal))


@explained("cw.squared_jerk", shaft="'load'")
def squared_jerk(shaft: str) -> SquaredJerk:
    """The integral over time of the square of the jerk of a shaft [rad2/s5] or a mass [m2/s5], for `sweep`.

    Parameters: shaft, its name. The jerk is the rate of its acceleration within each step of the solver; where the
    acceleration jumps, as it does when a clutch locks, the jerk has no square, and the jump itself does not count: ask
    for it by `cw.peak`, or soften what makes it. docs/theory/gradients.md (15)
    """
    return SquaredJerk(named("squared_jerk", shaft, "load"))


@explained("cw.jerk", shaft="'car'")
def jerk(shaft: str, window: Any = WINDOW, between: Any = None) -> FeltJerk:
    """The largest jerk of a shaft [rad/s3] or a mass [m/s3] that is felt, for `sweep`, gradients and `calibrate`.

    Parameters: shaft, its name; window [s], or with a unit, over which accelerations are averaged: shorter jerks do
    not count, 0.05 s is what a person feels; between, two times [s], at least two windows apart, by default the whole
    run. It is evaluated at 16 instants per window: a jump of the acceleration counts as its height over the window,
    less 3 % at most. A jump at the start of the run does not count, and jumps within one window of its ends count only
    in part. As a limit of `calibrate` it holds at all these instants. docs/theory/jerk.md (1)
    """
    length = plain_number(window, "s")
    if length is None or length <= 0.0:
        raise UseError("jerk", [f"window is {quote(window)}: give a time > 0 s, such as 0.05"])
    ends = None if between is None else pair(between, "s")
    if between is not None and (ends is None or ends[1] - ends[0] < 2.0 * length):
        raise UseError("jerk", [f"between is {quote(between)}: give two times [s], two windows apart or more"])
    return FeltJerk(named("jerk", shaft, "car"), length, ends)


@explained("cw.lock")
def lock(contact: str, number: int = 1) -> When:
    """When a contact locks [s], for `sweep`.

    Parameters: contact, its name; number, which time: 1 the first, -1 the last.
    """
    return When(named("lock", contact, "c1"), "lock", _counted("lock", number))


@explained("cw.break_away")
def break_away(contact: str, number: int = 1) -> When:
    """When a locked contact breaks away or opens [s], for `sweep`.

    Parameters: contact, its name; number, which time: 1 the first, -1 the last.
    """
    return When(named("break_away", contact, "c1"), "break_away", _counted("break_away", number))


def named(call: str, name: object, such: str = "shaft.torque") -> str:
    """A name that a call was given; UseError where it is none, with one such as is meant."""
    if not isinstance(name, str):
        raise UseError(call, [f"{quote(name)} is not a name; give one such as {such!r}"])
    return name


def _counted(call: str, number: object) -> int:
    if not isinstance(number, int) or isinstance(number, bool) or number == 0:
        raise UseError(call, [f"number is {quote(number)}: give 1 for the first, -1 for the last"])
    return number


def asked(outputs: Any, argument: str = "outputs") -> dict[str, Output]:
    """The outputs that a call means, by the name that the result gives them.

    Parameters: argument, what the call names them by.
    """
    mistakes = Mistakes()
    if isinstance(outputs, Mapping) and outputs:
        by_name = {str(name): mistakes.caught(partial(_output, one), AtEnd("")) for name, one in outputs.items()}
        mistakes.refuse("sweep")
        return by_name
    listed = [outputs] if isinstance(outputs, str) or callable(outputs) or not hasattr(outputs, "__iter__") else outputs
    made = [mistakes.caught(partial(_output, one), AtEnd("")) for one in listed]
    mistakes.refuse("sweep")
    found = dict[str, Output]()
    for one in made:
        if one.name in found and found[one.name] != one:
            remedy = f"name them: {argument}={{'first': ..., 'second': ...}}"
            raise UseError("sweep", [f"two outputs are called {one.name!r}; {remedy}"])
        found[one.name] = one
    if not found:
        are = "are" if argument.endswith("s") else "is"
        raise UseError("sweep", [f"{argument} {are} missing; name signals, such as 'load.speed', or cw.lock('c1')"])
    return found


def _output(one: Any) -> Output:
    if isinstance(one, AtEnd | AtTimes | Extreme | FeltJerk | Integral | SquaredJerk | When | Computed):
        return one
    if isinstance(one, str):
        return AtEnd(one)
    if callable(one):
        return Computed(one, getattr(one, "__name__", "function"))
    if hasattr(one, "needs"):
        # a goal or limit of `calibrate`, which is above this
        rest = "; take cw.jerk or cw.squared_jerk of the shaft" if "jerk" in one.name else ""
        raise UseError("sweep", [f"{one.name} is for calibrate alone{rest}"])
    remedy = "give the name of a signal, cw.at, cw.maximum, cw.lock ... of one, or a function of the run"
    raise UseError("sweep", [f"{quote(one)} is not an output; {remedy}"])


def missing(one: AtEnd | AtTimes | Extreme | FeltJerk | Integral | SquaredJerk, fault: str, signals: Any) -> str:
    """Why the signal of an output is not there: a shaft is named by itself, and its jerk by a call.

    Parameters: fault, what is said of the name of the signal alone; signals, the names that there are.
    """
    stem = one.signal.removesuffix(".speed")
    if isinstance(one, AtTimes) and stem in signals and stem != one.signal:
        # what `calibrate` makes of a jerk
        return missing(FeltJerk(stem, WINDOW), fault, signals)
    if isinstance(one, FeltJerk | SquaredJerk):
        call = "cw.jerk" if isinstance(one, FeltJerk) else "cw.squared_jerk"
        shafts = [name.removesuffix(".speed") for name in signals if name.endswith(".speed")]
        if one.shaft in signals:
            return f"{quote(one.shaft)} is a signal; give its shaft or mass: {call}({one.shaft.rpartition('.')[0]!r})"
        return f"no shaft or mass {quote(one.shaft)}{near(one.shaft, shafts) or f'; they are {listed(shafts)}'}"
    shaft = JERK_OF.fullmatch(one.signal)
    if shaft is None:
        return fault
    return f"no signal {quote(one.signal)}; a jerk is an output of its own: cw.jerk({shaft[1] or shaft[2]!r})"


def _missing(run: Trajectory, signal: str) -> Any:
    """What stands for a value that was not reached."""
    return "" if run.units[signal] == "" else np.nan
