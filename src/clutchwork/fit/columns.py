"""Columns of a file of measurements with their own units, cut to a window of time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.errors import FileError
from clutchwork.base.shown import shown
from clutchwork.fit.failure import FitError, refuse
from clutchwork.signals.bases.column_heads import Head, split
from clutchwork.signals.column import Column

Array = NDArray[np.float64]


class Read(NamedTuple):
    """What a column holds."""

    times: Array  # s
    values: Array  # in its unit
    unit: str  # empty: SI


def columns(
    path: str | Path, wanted: Mapping[str, str], time: str, group: str | None, window: Sequence[float] | None
) -> dict[str, Read]:
    """Columns of a file by what they are wanted for; FitError names all that cannot be used."""
    found, problems, span = dict[str, Read](), list[FitError](), _span(window)
    if not wanted:
        problems.append(FitError("measured", "is empty", "give at least one column"))
    for name, head in wanted.items():
        try:
            found[name] = _cut(_read(path, head, time, group), span)
        except FileError as error:
            problems += [FitError(name, f"cannot be read: {message}", remedy) for _, message, remedy in error.problems]
        except FitError as error:
            problems.append(FitError(name, error.message, error.remedy))
    refuse(problems)
    return found


def _read(path: str | Path, wanted: str, time: str, group: str | None) -> Read:
    """A column in the unit that the file says, or that is wanted where the file says none."""
    name, unit = split(wanted)
    column = Column(str(path), wanted, time=time, group=group)
    if unit and column.problems():
        # a channel has its unit beside its name
        plain = Column(str(path), name, time=time, group=group)
        column = column if plain.problems() else plain
    points, own = np.array(column.points), column.unit()
    scale = Head(wanted, own).scale()
    if unit and own and Head(wanted, unit).scale() != scale:
        raise FitError("column", f"{shown(name)} is in {own} in the file, not in {unit}", "leave out the unit")
    # what the unit is worth its signal decides: a temperature, or a difference of two
    return Read(points[:, 0], (points[:, 1] - scale.zero) / scale.factor, own or unit)


def _span(window: Sequence[float] | None) -> tuple[float, float] | None:
    if window is None:
        return None
    try:
        begin, end = (float(one) for one in window)
    except (TypeError, ValueError):
        begin = end = 0.0
    if not begin < end:
        raise FitError("window", f"is {shown(window)}", "give begin and end in [s], such as window=(12.5, 15.0)")
    return begin, end


def _cut(read: Read, span: tuple[float, float] | None) -> Read:
    """What is inside of a window, whose times count from its begin."""
    if span is None:
        return read
    inside = (read.times >= span[0]) & (read.times <= span[1])
    if not np.any(inside):
        told = f"has no sample from {span[0]:g} to {span[1]:g} s: times are {read.times[0]:g} to {read.times[-1]:g} s"
        raise FitError("column", told, "choose another window")
    return Read(read.times[inside] - span[0], read.values[inside], read.unit)
