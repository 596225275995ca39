"""Goals and limits: weighted sums of terms, with bounds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from clutchwork.base import UseError, dataclass, quote
from clutchwork.base.arrays import Array
from clutchwork.calibration.names import TimeTable
from clutchwork.calibration.terms import (
    Jerk,
    OutputUnits,
    Rows,
    SquaredSlope,
    TableSlope,
    Term,
    TermData,
    TimeSpan,
    is_computed,
    length,
    term,
)
from clutchwork.declare.calls import explained
from clutchwork.sweeps.numbers import bounds, number

SUCH = "give an output such as 'c1.heat', cw.lock('c1'), cw.jerk('car'), or {output: weight, ...}"


@dataclass(frozen=True)
class WeightedSum:
    """Terms with their weights; terms of several values add up value by value."""

    terms: tuple[tuple[Term, float], ...]

    @property
    def name(self) -> str:
        """What messages call it."""
        parts = [one.name if weight == 1.0 else f"{weight:g} {one.name}" for one, weight in self.terms]
        return " + ".join(parts).replace("+ -1 ", "- ").replace("+ -", "- ")

    def needs(self, span: TimeSpan) -> list[Any]:
        """The outputs of a run that it is made of."""
        return [output for one, _ in self.terms for output in one.needs(span)]

    def rows(self, given: TermData) -> Rows:
        """Its values, and their derivatives by the numbers."""
        values, slopes = np.zeros(1), np.zeros((1, len(given.numbers)))
        at = 0
        for one, weight in self.terms:
            count = sum(map(length, one.needs(given.span)))
            own = given._replace(values=given.values[at : at + count], slopes=given.slopes[at : at + count])
            value, slope = one.rows(own)
            values, slopes = values + weight * value, slopes + weight * slope
            at += count
        return values, slopes

    def faults(self, span: TimeSpan, curves: Mapping[str, TimeTable]) -> list[str]:
        """Windows longer than a run, and terms whose values cannot be added."""
        found = [fault for one, _ in self.terms if isinstance(one, Jerk) for fault in one.faults(span)]
        if found:
            return found
        counts = {one.name: self.counted(one, span, curves) for one, _ in self.terms}
        if len(set(counts.values()) - {1}) > 1:
            said = ", ".join(f"{name} has {count}" for name, count in counts.items())
            return [f"{self.name}: terms of several values add up one by one, but {said}; give a limit for each"]
        return []

    def is_several(self, span: TimeSpan, curves: Mapping[str, TimeTable]) -> bool:
        """Whether it has several values."""
        return any(self.counted(one, span, curves) > 1 for one, _ in self.terms)

    @staticmethod
    def counted(one: Term, span: TimeSpan, curves: Mapping[str, TimeTable]) -> int:
        """How many values a term has."""
        needed = sum(map(length, one.needs(span)))
        none = np.zeros(0)
        return len(one.rows(TermData(np.zeros(needed), np.zeros((needed, 0)), none, {}, curves, span))[0])

    def unit(self, units: OutputUnits) -> str:
        """That of its terms where all have one."""
        found = {one.unit(units) for one, _ in self.terms}
        return found.pop() if len(found) == 1 else ""

    @property
    def tables(self) -> list[str]:
        """Names of the tables whose slopes it has."""
        return [one.stem for one, _ in self.terms if isinstance(one, TableSlope | SquaredSlope)]

    @property
    def needs_run(self) -> bool:
        """Whether it is known only after a run."""
        return any(one.needs(TimeSpan(0.0, 1.0)) for one, _ in self.terms)


def summed(given: Any) -> tuple[WeightedSum | None, str]:
    """The sum that is meant, or what is wrong with it."""
    pairs = given.items() if isinstance(given, Mapping) else [(given, 1.0)]
    made = list[tuple[Term, float]]()
    for one, weight in pairs:
        found, factor = term(one), number(weight, "1")
        if found is None:
            why = "a function of the run has no derivative; " if is_computed(one) else ""
            return None, f"{quote(one)} is not an output: {why}{SUCH}"
        if factor is None:
            return None, f"the weight of {found.name} is {quote(weight)}: give a number"
        made.append((found, factor))
    return (WeightedSum(tuple(made)), "") if made else (None, f"is empty: {SUCH}")


@dataclass(frozen=True)
class Limit:
    """An upper or a lower bound, or both, of what a run gives."""

    what: Any
    lower: Any
    upper: Any
    name: str = ""

    def settled(self, units: OutputUnits) -> tuple[Settled | None, list[str]]:
        """With numbers in SI, or all that is wrong with it."""
        found, fault = summed(self.what)
        if found is None:
            return None, [fault]
        name = self.name or found.name
        if self.lower is None and self.upper is None:
            return None, [f"limit of {name}: give lower=, upper= or both"]
        unit = found.unit(units)
        ends = bounds(self.lower, self.upper, unit)
        if ends is None:
            given = " and ".join(quote(one) for one in (self.lower, self.upper) if one is not None)
            wanted = f"finite numbers{f' in {unit}' if unit else ''}, or with a unit that fits, the lower one first"
            return None, [f"limit of {name} is {given}: give {wanted}"]
        return Settled(found, *ends, name, unit), []


@dataclass(frozen=True)
class Settled:
    """A limit in SI."""

    what: WeightedSum
    lower: float
    upper: float
    name: str
    unit: str

    @property
    def is_equal(self) -> bool:
        """Whether one value alone is allowed."""
        return self.lower == self.upper

    def violation(self, values: Array) -> float:
        """By how much values are outside, at most; 0 inside."""
        return float(max(np.max(values - self.upper), np.max(self.lower - values), 0.0))


@explained("cw.limit", what="'c1.heat'")
def limit(what: Any, lower: Any = None, upper: Any = None, *, name: str = "") -> Limit:
    """A limit for `cw.calibrate`: `cw.limit("c1.heat", upper="40 kJ")`.

    Parameters: what, an output of a run as `cw.sweep` takes it, cw.jerk, cw.rms_jerk, cw.slope or cw.squared_slope, or
    a sum {output: weight, ...}; lower and upper, its bounds in SI or with a unit, equal where only one value will do;
    name, what the report calls it. One of several values, as cw.jerk or cw.slope, is within its bounds with all.
    """
    if not isinstance(name, str):
        raise UseError("limit", [f"name is {quote(name)}: give a string"])
    return Limit(what, lower, upper, name)
