"""One column of any file over its times: found, checked and converted to SI."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from clutchwork.base import FileError, listed, near, quote
from clutchwork.signals.bases import column_file, sheets
from clutchwork.signals.bases.column_file import MOST_FAULTS, MOST_LINES, ColumnRequest, ColumnValues
from clutchwork.signals.bases.column_heads import ColumnHead
from clutchwork.signals.bases.measured.formats import format_of, opened
from clutchwork.signals.bases.measured.series import Array, Clock, Series

Faults = list[tuple[str, str, str]]


def read(where: str, wanted: ColumnRequest) -> ColumnValues:
    """The column of the file at a path; FileError names what is wrong with the file, up to a few mistakes."""
    try:
        # what was read as a sheet is a CSV file
        form = "" if sheets.known(where) else format_of(Path(where))
    except OSError:
        form = ""
    if not form:
        if wanted.group:
            raise wanted.error("group", "has no groups: it is a CSV file", "remove group")
        return column_file.read(where, wanted)
    try:
        with opened(Path(where), form, wanted.path) as found:
            one = pick(found, wanted)
            clock, values = _clock(one, found, wanted), one.values()
            invalid = one.invalid()
    except ImportError as missing:
        raise FileError([("path", str(missing), "")]) from None
    _refuse_lengths(clock, values, wanted)
    heads = ColumnHead(clock.name, clock.unit), ColumnHead(one.name, one.unit)
    faults = list(_faults(one.name, clock, values, invalid, wanted))
    if faults:
        raise FileError(faults[:MOST_FAULTS])
    return column_file.in_si(np.column_stack([clock.values, values]), heads, wanted)


def pick(found: list[Series], wanted: ColumnRequest) -> Series:
    """The series that a name refers to."""
    groups = list(dict.fromkeys(one.group for one in found if one.group))
    if wanted.group and wanted.group not in groups:
        raise wanted.error(
            "group",
            f"has no group {quote(wanted.group)}",
            f"the groups are {listed(groups)}{near(wanted.group, groups)}",
        )
    known = [one for one in found if wanted.group in ("", one.group)]
    meant = [one for one in known if one.name == wanted.column]
    meant = meant or [one for one in known if one.is_called(wanted.column)]
    if not meant:
        names = list(dict.fromkeys(one.name for one in known))
        hint = near(wanted.column, [*names, *(alias for one in known for alias in one.aliases)])
        raise wanted.error("column", f"has no column {quote(wanted.column)}", f"the columns are {listed(names)}{hint}")
    if len(meant) > 1:
        raise wanted.error("column", f"has {len(meant)} columns {quote(wanted.column)}", _choice(meant))
    if meant[0].is_text:
        raise wanted.error("column", f"has words in column {quote(wanted.column)}, no numbers", "choose another column")
    return meant[0]


def _choice(meant: list[Series]) -> str:
    """How to choose among series of one name."""
    if len({one.group for one in meant}) == len(meant):
        return f"choose with group: {listed(repr(one.group) for one in meant)}"
    if len({one.name for one in meant}) == len(meant):
        return f"name one of them: {listed(one.name for one in meant)}"
    return "give every column of the file a different name"


def _clock(one: Series, found: list[Series], wanted: ColumnRequest) -> Clock:
    clock = one.clock(wanted.time)
    named = [
        other for other in found if other.is_called(wanted.time) and other.group == one.group and not other.is_text
    ]
    if clock is None and len(named) == 1:
        clock = Clock(named[0].name, named[0].unit, named[0].values())
    if clock is None:
        alike = [other.name for other in found if other.samples == one.samples and other.group == one.group]
        others = [name for name in alike if name != one.name]
        fellows = f"columns of as many samples are {listed(others)}{near(wanted.time, others)}" if others else ""
        remedy = f"name the one with the times: time=...; {fellows}" if fellows else "write the times into the file"
        raise wanted.error("time", f"has no times {quote(wanted.time)} of column {quote(one.name)}", remedy)
    return clock


def _refuse_lengths(clock: Clock, values: Array, wanted: ColumnRequest) -> None:
    if values.ndim != 1 or values.dtype.kind != "f":
        raise wanted.error("column", f"has no numbers in column {quote(wanted.column)}", "choose another column")
    if len(values) != len(clock.values):
        told = f"has {len(values)} values in column {quote(wanted.column)} and {len(clock.values)} times"
        raise wanted.error("column", told, "give one time for each value")
    if not len(values):
        raise wanted.error("column", f"has no sample in column {quote(wanted.column)}", "choose another column")
    if len(values) > MOST_LINES:
        raise wanted.error("path", f"has more than {MOST_LINES} samples", "give fewer samples")


def _faults(
    name: str, clock: Clock, values: Array, invalid: Array | None, wanted: ColumnRequest
) -> Iterator[tuple[str, str, str]]:
    """Samples that cannot be used, by their times in the unit of the file."""
    path, times, unit = quote(wanted.path), clock.values, clock.unit or "s"
    for place in np.flatnonzero(~np.isfinite(times))[:MOST_FAULTS]:
        yield "time", f"{path}: the time of sample {place} is not a finite number", "remove this sample"
    for place in np.flatnonzero(np.diff(times) < 0.0)[:MOST_FAULTS]:
        told = f"{path}: time {times[place + 1]:.9g} {unit} of sample {place + 1} is before {times[place]:.9g} {unit}"
        yield "time", told, "sort the samples by time"
    marked = np.zeros(len(values), bool) if invalid is None else np.asarray(invalid, bool)
    for place in np.flatnonzero(marked)[:MOST_FAULTS]:
        told = f"{path}: the sample of {quote(name)} at {times[place]:.9g} {unit} is marked as invalid"
        yield "column", told, "cut it out, or replace it"
    for place in np.flatnonzero(~np.isfinite(values))[:MOST_FAULTS]:
        told = f"{path}: the sample of {quote(name)} at {times[place]:.9g} {unit} is not a finite number"
        yield "column", told, "cut it out, or replace it"
