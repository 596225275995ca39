"""What was measured in one run, and what was done in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from clutchwork.base import FileError, dataclass, listed, near, quote
from clutchwork.base.arrays import Array
from clutchwork.fit.failure import FitError, refuse
from clutchwork.signals.bases.column_file import names_of
from clutchwork.signals.bases.column_heads import ColumnHead, split
from clutchwork.signals.bases.measured.formats import format_of
from clutchwork.signals.column import Column


@dataclass(frozen=True, eq=False)
class Record:
    """One measured run of a driveline, for `fit_records`.

    Parameters: time [s], rising, at which the samples were taken; the run begins at 0 s. measured, samples by the name
    of the signal, "engine.speed", a row of numbers or, where a signal has instants of its own, a pair (times, values).
    inputs, what drove this run by the name of the input, "c1.pressure": a row over `time`, a pair, a number or a
    signal. start, initial values of this run, {"engine.speed": 150.0}. deviation, standard deviation of the noise by
    signal, a number or one for each sample, by which samples count; without any, each signal counts by its own size.
    units, in which numbers of `measured` and `inputs` are by name, where that is not SI. name, for messages.
    """

    time: Any = field(repr=False)
    measured: Mapping[str, Any] = field(repr=False)
    inputs: Mapping[str, Any] = field(default_factory=dict, repr=False)
    start: Mapping[str, Any] = field(default_factory=dict)
    deviation: Mapping[str, Any] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    name: str = ""
    # columns of a file that say none, by name
    without_unit: Mapping[str, str] = field(default_factory=dict, repr=False)

    @classmethod
    def read(
        cls,
        path: str | Path,
        measured: Mapping[str, str],
        inputs: Mapping[str, str] | None = None,
        *,
        time: str = "time",
        window: Sequence[float] | None = None,
        start: Mapping[str, Any] | None = None,
        deviation: Mapping[str, Any] | None = None,
        group: str | None = None,
        name: str = "",
    ) -> Record:
        """A record from a CSV, MDF, MAT, Parquet or NetCDF file.

        Parameters: measured and inputs, columns by the name of the signal or the input: {"engine.speed": "n_eng"},
        with a unit where the file says none, "n_eng [1/min]", otherwise they are taken as SI, which `notes` of the fit
        say; time, column with the times, where it is not called "time"; window, begin and end [s]
        of what is used: times count from its begin. start, deviation, which is in SI, and name as of `Record`, by
        default the name of the file; group, of the channels of an MDF file.

        Units of the file are converted, those that do not fit are refused by the fit. FitError names all columns that
        cannot be used.
        """
        asked = {**measured, **(inputs or {})}
        found = columns(path, asked, time, group, window)
        pairs = {key: (one.times, one.values) for key, one in found.items()}
        return cls(
            next(iter(pairs.values()))[0],
            {key: pairs[key] for key in measured},
            {key: pairs[key] for key in inputs or {}},
            dict(start or {}),
            dict(deviation or {}),
            {key: one.unit for key, one in found.items() if one.unit},
            name or Path(path).stem,
            {key: asked[key] for key, one in found.items() if not one.unit},
        )


class ReadColumn(NamedTuple):
    """What a column holds."""

    times: Array  # s
    values: Array  # in its unit
    unit: str  # empty: SI


def columns(
    path: str | Path, wanted: Mapping[str, str], time: str, group: str | None, window: Sequence[float] | None
) -> dict[str, ReadColumn]:
    """Columns of a file by what they are wanted for; FitError names all that cannot be used."""
    found, problems, span = dict[str, ReadColumn](), dict[str, FitError](), _span(window)
    if not wanted:
        problems["measured"] = FitError("measured", "is empty", "give at least one column")
    for name, head in wanted.items():
        try:
            found[name] = _cut(_read(path, head, time, group), span)
        except FileError as error:
            # what is wrong with the times is so for all columns
            problems |= {str(one): one for one in _faults(path, name, head, time, error)}
        except FitError as error:
            problems[name] = FitError(name, error.message, error.remedy)
    refuse(list(problems.values()))
    return found


def _faults(path: str | Path, name: str, head: str, time: str, error: FileError) -> Iterator[FitError]:
    """What is wrong with a column; one that is not there is answered with those that are."""
    known = _names(path)
    for quantity, message, remedy in error.problems:
        wanted = time if quantity == "time" else head
        hint = near(wanted, known) or near(split(wanted)[0], [split(one)[0] for one in known])
        missing = known and message.endswith(f"has no column {quote(wanted)}")
        told = f"the columns are {listed(known)}{hint}" if missing else remedy
        if quantity == "time":
            yield FitError("time", f"cannot be read: {message}", f"give time=...; {told}" if missing else told)
        else:
            yield FitError(name, f"cannot be read: {message}", told)


def _names(path: str | Path) -> list[str]:
    """The heads of a CSV file; other formats say them of themselves."""
    try:
        return [] if format_of(Path(path)) else names_of(Path(path))
    except OSError:
        return []


def _read(path: str | Path, wanted: str, time: str, group: str | None) -> ReadColumn:
    """A column in the unit that the file says, or that is wanted where the file says none."""
    name, unit = split(wanted)
    column = Column(str(path), wanted, time=time, group=group)
    if unit and column.problems():
        # a channel has its unit beside its name
        plain = Column(str(path), name, time=time, group=group)
        column = column if plain.problems() else plain
    points, own = np.array(column.points), column.unit()
    scale = ColumnHead(wanted, own).scale()
    if unit and own and ColumnHead(wanted, unit).scale() != scale:
        raise FitError("column", f"{quote(name)} is in {own} in the file, not in {unit}", "leave out the unit")
    # what the unit is worth its signal decides: a temperature, or a difference of two
    return ReadColumn(points[:, 0], (points[:, 1] - scale.zero) / scale.factor, own or unit)


def _span(window: Sequence[float] | None) -> tuple[float, float] | None:
    if window is None:
        return None
    try:
        begin, end = (float(one) for one in window)
    except (TypeError, ValueError):
        begin = end = 0.0
    if not begin < end:
        raise FitError("window", f"is {quote(window)}", "give begin and end in [s], such as window=(12.5, 15.0)")
    return begin, end


def _cut(read: ReadColumn, span: tuple[float, float] | None) -> ReadColumn:
    """What is inside of a window, whose times count from its begin."""
    if span is None:
        return read
    inside = (read.times >= span[0]) & (read.times <= span[1])
    if not np.any(inside):
        told = f"has no sample from {span[0]:g} to {span[1]:g} s: times are {read.times[0]:g} to {read.times[-1]:g} s"
        raise FitError("column", told, "choose another window")
    return ReadColumn(read.times[inside] - span[0], read.values[inside], read.unit)
