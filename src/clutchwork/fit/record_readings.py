"""Other readings of records: units and columns that may be mistaken, named where they fit much better."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.base import ModelError, dataclass
from clutchwork.base.arrays import Array
from clutchwork.declare.node import Signal
from clutchwork.fit.descent import Descent
from clutchwork.fit.driven import Driven, driven
from clutchwork.fit.failure import FitError
from clutchwork.fit.readings import FAIR, FITS, named
from clutchwork.fit.record import Record
from clutchwork.fit.traces import label
from clutchwork.model.changes import named as owners_by_name
from clutchwork.model.changes import target, unit_of

# units of test benches by that of SI
BENCH = {
    "rad/s": ("1/min", "deg/s"),
    "Pa": ("bar", "kPa", "MPa"),
    "N m": ("kN m",),
    "m/s": ("km/h",),
    "K": ("degC",),
}
# readings that are fitted, the nearest at the start values first
MOST = 3


class OtherUnit(NamedTuple):
    """Names that may be in another unit than that in which they are read."""

    names: tuple[str, ...]
    was: str
    unit: str


class Reading(NamedTuple):
    """Records with one thing read in another way."""

    words: str
    records: Sequence[Record]


@dataclass(frozen=True, eq=False)
class ReadingTrial:
    """A reading with the runs of the start values."""

    words: str
    records: Sequence[Driven]
    left: float  # share of the variation of the samples that these runs leave


@dataclass(frozen=True, eq=False)
class RecordReadings:
    """Other readings of the records of a fit.

    Parameters: given, the records as they are read, in the order of those of `descent`.
    """

    system: System
    given: Sequence[Record]
    descent: Descent

    def fitted(self, left: float, r2_of: Callable[[Sequence[Driven]], float]) -> list[str]:
        """Readings with which a fit is much better, in words: the best one, and others that are about as good.

        Parameters: left, share of the variation that the fit leaves; r2_of, that of a fit of other records.
        """
        found = list[tuple[float, str]]()
        for trial in self.near()[:MOST]:
            try:
                found.append((1.0 - r2_of(trial.records), trial.words))
            except (FitError, ModelError):
                continue
        return named(found, left)

    def noted(self) -> list[str]:
        """The reading that is meant where the start values alone say so: a fit can make up for a wrong unit."""
        found = self.near()[:1]
        return [
            f"likely {one.words}: with that the start values have r2 {1.0 - one.left:.3g}"
            for one in found
            if one.left < FAIR
        ]

    def near(self) -> list[ReadingTrial]:
        """Readings that the runs of the start values are much closer to, the nearest first."""
        now = _left(self.descent, _runs(self.descent))
        return sorted((one for one in self._trials() if one.left < FITS * now), key=lambda one: one.left)

    def _trials(self) -> Iterator[ReadingTrial]:
        """All readings, those with other runs also with other units of all measured signals."""
        here, measured, inputs = Reading("", self.given), self._measured(), self._inputs()
        as_given = [*self._in_units(here, self._units(measured, alone=True)), *self._swapped()]
        yield from self._of_one_run(as_given, _runs(self.descent))
        for other in (*self._in_units(here, self._units(inputs, alone=True)), *_milliseconds(here)):
            both = self._in_units(other, self._units(measured, alone=False))
            yield from self._of_one_run([other, *both], None)

    def _of_one_run(self, readings: Sequence[Reading], runs: list[Array] | None) -> Iterator[ReadingTrial]:
        """Readings that have the same runs; None: those of the first one."""
        for one in readings:
            problems = list[FitError]()
            records = driven(self.system, one.records, problems)
            if problems:
                continue
            descent = Descent(records, self.descent.numbers)
            try:
                runs = _runs(descent) if runs is None else runs
            except ModelError:
                return
            yield ReadingTrial(one.words, records, _left(descent, runs))

    def _measured(self) -> dict[str, str]:
        """Units of SI of the measured signals."""
        return {one.signal: one.unit for one in self.descent.traces if one.unit in BENCH}

    def _inputs(self) -> dict[str, str]:
        """Units of SI of inputs that are numbers."""
        source = self.system.source
        rows = {name for one in self.given for name, row in one.inputs.items() if not isinstance(row, Signal | str)}
        aims = {name: target(owners_by_name(source), name) for name in sorted(rows)} if source else {}
        return {name: unit_of(aim) for name, aim in aims.items() if aim and unit_of(aim) in BENCH}

    def _units(self, known: Mapping[str, str], *, alone: bool) -> list[OtherUnit]:
        """Units that names may have, those of one unit together and, if asked for, each alone."""
        groups = dict[tuple[str, str], list[str]]()
        for name, si in known.items():
            was = next((one.units[name] for one in self.given if name in one.units), si)
            groups.setdefault((si, was), []).append(name)
        return [
            OtherUnit(names, was, unit)
            for (si, was), group in groups.items()
            for unit in (si, *BENCH[si])
            for names in dict.fromkeys([tuple(group), *((name,) for name in group if alone)])
            if unit != was
        ]

    def _in_units(self, reading: Reading, others: Sequence[OtherUnit]) -> list[Reading]:
        said = f"{reading.words}, and " if reading.words else ""
        return [
            Reading(f"{said}{self._words(*one)}", [_in_unit(each, one) for each in reading.records]) for one in others
        ]

    def _words(self, names: tuple[str, ...], was: str, unit: str) -> str:
        verb, were = ("are", "were") if len(names) > 1 else ("is", "was")
        said = f"{' and '.join(names)} {verb} in {unit} and {were} taken as {was}"
        if any(name in one.units for one in self.given for name in names):
            return said
        heads = [one.without_unit[name] for one in self.given[:1] for name in names if name in one.without_unit]
        if heads:
            return f"{said}: give {' and '.join(repr(f'{head} [{unit}]') for head in heads)}"
        return f"{said}: give units={dict.fromkeys(names, unit)}"

    def _swapped(self) -> Iterator[Reading]:
        """Two signals that are each other, in all records or in one."""
        pairs = list(combinations(self.descent.signals, 2))
        everywhere = range(len(self.given))
        for places in dict.fromkeys([tuple(everywhere), *((place,) for place in everywhere)]):
            of = f" of {label(self.given[places[0]], places[0])}" if len(places) < len(everywhere) else ""
            for one, other in pairs:
                records = [
                    _exchanged(record, one, other) if place in places else record
                    for place, record in enumerate(self.given)
                ]
                if any(record is not before for record, before in zip(records, self.given, strict=True)):
                    yield Reading(f"{one} and {other}{of} are swapped", records)


def _in_unit(record: Record, other: OtherUnit) -> Record:
    known = {*record.measured, *record.inputs}
    return replace(record, units={**record.units, **{name: other.unit for name in other.names if name in known}})


def _exchanged(record: Record, one: str, other: str) -> Record:
    """A record with the columns of two signals exchanged, where it has both at the same instants."""
    if not {one, other} <= set(record.measured):
        return record
    swap = {one: other, other: one}
    rows = [record.measured[name] for name in swap]
    times = [row[0] if isinstance(row, tuple) else record.time for row in rows]
    if not np.array_equal(times[0], times[1]):
        return record
    measured = {name: record.measured[swap.get(name, name)] for name in record.measured}
    units = {swap.get(name, name): unit for name, unit in record.units.items()}
    return replace(record, measured=measured, units=units)


def _milliseconds(reading: Reading) -> Iterator[Reading]:
    """Times that are thousand times too long."""
    rows = [row for one in reading.records for row in (*one.measured.values(), *one.inputs.values())]
    if not any(isinstance(row, tuple) for row in rows):
        records = [replace(one, time=np.asarray(one.time, dtype=float) / 1000.0) for one in reading.records]
        yield Reading("time is in ms and was taken as s", records)


def _runs(descent: Descent) -> list[Array]:
    """The signals of each record at its samples, as the runs of the start values have them."""
    numbers = descent.numbers
    values = numbers.values(np.clip(numbers.codes(), descent.lower, descent.upper))
    return [function(values[numbers.places(place)]) for place, function in enumerate(descent.functions)]


def _left(descent: Descent, runs: Sequence[Array]) -> float:
    """Share of the variation of the samples that runs leave: how large the samples are does not count."""
    values, weights = np.concatenate(descent.measured), np.concatenate(descent.weights)
    off, variation = (np.concatenate(runs) - values) / weights, 0.0
    for places in descent.signals.values():
        own = np.concatenate(places)
        variation += float(np.sum(((values[own] - np.mean(values[own])) / weights[own]) ** 2))
    return float(np.sum(off**2)) / (variation or 1.0)
