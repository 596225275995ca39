"""What goals and limits are made of: outputs of a run, the jerk of a shaft, slopes of tables that are free.

Each term gives one number or several with their derivatives by the numbers of the model.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, NamedTuple, Protocol, TypeAlias

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.base import UnknownName, UseError, dataclass
from clutchwork.base.arrays import Array
from clutchwork.calibration.names import TimeTable, curve
from clutchwork.declare.calls import explained
from clutchwork.gradients.parameters import Tunable
from clutchwork.results.channels import channels
from clutchwork.sweeps.outputs import (
    AtEnd,
    AtTimes,
    Computed,
    Extreme,
    FeltJerk,
    Integral,
    Output,
    SquaredJerk,
    When,
    named,
)
from clutchwork.sweeps.result import JERKS, unit_of

OUTPUTS = (AtEnd, AtTimes, Extreme, Integral, SquaredJerk, When)


class TimeSpan(NamedTuple):
    """When a run begins and ends [s]."""

    begin: float
    end: float


class TermData(NamedTuple):
    """What a term is computed from."""

    values: Array  # of the outputs that it needs
    slopes: Array  # of these by the numbers, shape (outputs, numbers)
    numbers: Array
    places: Mapping[str, int]  # of the numbers by name
    curves: Mapping[str, TimeTable]
    span: TimeSpan


def length(output: Any) -> int:
    """How many numbers an output of a run has."""
    return len(output.times) if isinstance(output, AtTimes) else 1


class OutputUnits:
    """Units of outputs and tables of a System; what is not there is without one, and refused where it is run."""

    def __init__(self, system: System) -> None:
        self.system, self.channels = system, channels(system, True, True)

    def output(self, one: Any) -> str:
        """Of an output of a run."""
        try:
            return unit_of(one, self.channels)
        except UnknownName:
            return ""

    def table(self, stem: str) -> str:
        """Of the values of a table."""
        try:
            return curve(self.system, stem).values[0].unit
        except UseError:
            return ""


Rows: TypeAlias = "tuple[Array, Array]"


class Term(Protocol):
    """One of them."""

    @property
    def name(self) -> str:
        """What messages call it."""

    def needs(self, span: TimeSpan) -> list[Any]:
        """The outputs of a run that it is made of."""

    def unit(self, units: OutputUnits) -> str:
        """Its unit."""

    def rows(self, given: TermData) -> Rows:
        """Its values, and their derivatives by the numbers."""


@dataclass(frozen=True)
class OutputTerm:
    """An output of a run as it is; one at several instants has as many values."""

    output: Any

    @property
    def name(self) -> str:
        """What messages call it."""
        return str(self.output.name)

    def needs(self, span: TimeSpan) -> list[Any]:  # noqa: ARG002, others do
        """Itself."""
        return [self.output]

    def unit(self, units: OutputUnits) -> str:
        """That of the output."""
        return units.output(self.output)

    def rows(self, given: TermData) -> Rows:
        """What the run gave."""
        return given.values, given.slopes


@dataclass(frozen=True)
class OfShaft:
    """A term made of the jerk of a shaft or a mass."""

    word: ClassVar[str]
    shaft: str

    @property
    def name(self) -> str:
        """What messages call it."""
        return f"{self.word}({self.shaft})"

    def unit(self, units: OutputUnits) -> str:
        """Of its speed, over seconds squared."""
        return JERKS.get(units.output(AtEnd(f"{self.shaft}.speed")), "")


@dataclass(frozen=True)
class OfTable:
    """A term made of the pieces of a table, which needs no run."""

    word: ClassVar[str]
    stem: str

    @property
    def name(self) -> str:
        """What messages call it."""
        return f"{self.word}({self.stem})"

    def needs(self, span: TimeSpan) -> list[Any]:  # noqa: ARG002, others do
        """No run."""
        return []


@dataclass(frozen=True)
class Jerk:
    """The magnitude of the jerk of a shaft or a mass at all instants at which it is felt."""

    jerk: FeltJerk

    @property
    def name(self) -> str:
        """What messages call it."""
        return self.jerk.name

    @property
    def shaft(self) -> str:
        """Whose jerk it is."""
        return self.jerk.shaft

    def unit(self, units: OutputUnits) -> str:
        """That of the output."""
        return units.output(self.jerk)

    def needs(self, span: TimeSpan) -> list[Any]:
        """Its speed at instants that lie a small part of a window apart."""
        return [AtTimes(self.jerk.signal, tuple(self.jerk.times(*span).tolist()))]

    def faults(self, span: TimeSpan) -> list[str]:
        """Why there is no window in a run."""
        return self.jerk.faults(*span)

    def rows(self, given: TermData) -> Rows:
        """Two values for each window: of either sign, the larger one is the size."""
        value, slope = self.jerk.felt(given.values), self.jerk.felt(given.slopes)
        return np.concatenate([value, -value]), np.concatenate([slope, -slope])


@dataclass(frozen=True)
class RmsJerk(OfShaft):
    """The root of the mean square of the jerk of a shaft or a mass over the run."""

    word: ClassVar[str] = "rms_jerk"

    def needs(self, span: TimeSpan) -> list[Any]:  # noqa: ARG002, others do
        """The integral of its square."""
        return [SquaredJerk(self.shaft)]

    def rows(self, given: TermData) -> Rows:
        """One value."""
        time = given.span.end - given.span.begin
        value = np.sqrt(given.values / time)
        # at rest all the while it has no derivative, and cannot be less
        return value, given.slopes / (2.0 * time * np.maximum(value, 1e-12))


@dataclass(frozen=True)
class TableSlope(OfTable):
    """Slopes of the pieces of a table."""

    word: ClassVar[str] = "slope"

    def unit(self, units: OutputUnits) -> str:
        """Of the table, a second."""
        return f"{units.table(self.stem)}/s"

    def rows(self, given: TermData) -> Rows:
        """One value for each piece."""
        step, by_step, rise, by_rise = _pieces(given, self.stem)
        value = rise / step
        return value, (by_rise - value[:, None] * by_step) / step[:, None]


@dataclass(frozen=True)
class SquaredSlope(OfTable):
    """The integral over time of the square of the slope of a table."""

    word: ClassVar[str] = "squared_slope"

    def unit(self, units: OutputUnits) -> str:
        """Of the table squared, a second."""
        return f"({units.table(self.stem)})2/s"

    def rows(self, given: TermData) -> Rows:
        """One value."""
        step, by_step, rise, by_rise = _pieces(given, self.stem)
        slope = rise / step
        gradient = (2.0 * slope) @ by_rise - (slope**2) @ by_step
        return np.array([rise @ slope]), gradient[None, :]

    def curvature(self, given: TermData) -> Array:
        """Its second derivative by the numbers where times stay."""
        step, _, _, by_rise = _pieces(given, self.stem)
        made: Array = 2.0 * (by_rise.T / step) @ by_rise
        return made


def _pieces(given: TermData, stem: str) -> tuple[Array, Array, Array, Array]:
    """Lengths and rises of the pieces of a table that take time, and their derivatives by the numbers."""
    table = given.curves[stem]
    sides = [_column(given, column) for column in (table.times, table.values)]
    (step, by_step), (rise, by_rise) = ((np.diff(value), np.diff(slope, axis=0)) for value, slope in sides)
    # a jump has no slope
    long = np.diff([one.start for one in table.times]) > 0.0
    return step[long], by_step[long], rise[long], by_rise[long]


def _column(given: TermData, column: Sequence[Tunable]) -> Rows:
    """Times or values of a table as they are now, and their derivatives by the numbers."""
    made, slopes = np.array([one.start for one in column]), np.zeros((len(column), len(given.numbers)))
    for row, one in enumerate(column):
        if one.name in given.places:
            place = given.places[one.name]
            made[row], slopes[row, place] = given.numbers[place], 1.0
    return made, slopes


@explained("cw.rms_jerk", shaft="'car'")
def rms_jerk(shaft: str) -> RmsJerk:
    """The root of the mean square of the jerk of a shaft [rad/s3] or a mass [m/s3] over a run, for `calibrate`.

    Parameters: shaft, its name. Jumps of the acceleration do not count, as in `cw.squared_jerk`.
    """
    return RmsJerk(named("rms_jerk", shaft, "car"))


@explained("cw.slope", signal="'c1.pressure'")
def slope(signal: str) -> TableSlope:
    """The slopes of the pieces of a table for `calibrate`, in the unit of its values a second.

    Parameters: signal, the name of the table, such as "c1.pressure".
    """
    return TableSlope(named("slope", signal, "c1.pressure"))


@explained("cw.squared_slope", signal="'c1.pressure'")
def squared_slope(signal: str) -> SquaredSlope:
    """The integral of the square of the slope of a table for `calibrate`: how uneven a profile is.

    Parameters: signal, the name of the table, such as "c1.pressure".
    """
    return SquaredSlope(named("squared_slope", signal, "c1.pressure"))


def term(given: Any) -> Term | None:
    """The term that a goal or a limit means; None where it is none."""
    if isinstance(given, str):
        return OutputTerm(AtEnd(given))
    if isinstance(given, FeltJerk):
        return Jerk(given)
    if isinstance(given, RmsJerk | TableSlope | SquaredSlope):
        return given
    return OutputTerm(given) if isinstance(given, OUTPUTS) else None


def is_computed(given: Any) -> bool:
    """Whether it is a function of a run, which has no derivative."""
    return isinstance(given, Computed) or callable(given)


__all__ = ["Output", "Term", "rms_jerk", "slope", "squared_slope", "term"]
