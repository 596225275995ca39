"""What a file of another program holds: series of samples, each with the times of its samples."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.signals.bases.column_heads import split
from clutchwork.signals.bases.measured.other_units import own_unit

Array = NDArray[Any]
# unit, number of samples, whether they are text, and what gives them
ColumnOf = tuple[str, int, bool, Callable[[], Array]]

# names of times that are taken where none is asked for
CLOCKS = ("time", "t", "zeit", "timestamps", "tout")


@dataclass(frozen=True)
class Clock:
    """Times of samples: their name in the file, their unit there, and their values."""

    name: str
    unit: str
    values: Array


@dataclass(frozen=True)
class Series:
    """One column, channel or variable of a file."""

    name: str
    unit: str  # as clutchwork writes it, empty where the file says none
    samples: int
    values: Callable[[], Array]
    clock: Callable[[str], Clock | None]  # by the name that is asked for, "time" by default
    group: str = ""  # what it stands in, where a file may have several of one name
    aliases: tuple[str, ...] = ()  # further names that it may be asked for by
    is_text: bool = False
    invalid: Callable[[], Array | None] = lambda: None  # samples that the file itself calls invalid

    def is_called(self, name: str) -> bool:
        """Whether a name means it; a unit may stand with the name."""
        known, (bare, unit) = (self.name, *self.aliases), split(name)
        return name in known or (bare in known and unit == self.unit != "")


def headed(name: str, unit: str) -> tuple[str, str]:
    """Name and unit of a column; where a file says no unit elsewhere, a head such as `c1 [bar]` may."""
    if unit.strip():
        return name, own_unit(unit)
    bare, told = split(name)
    return (bare, own_unit(told)) if told else (name, "")


def table(columns: dict[str, ColumnOf], preferred: str = "") -> list[Series]:
    """Series of a file whose columns stand side by side.

    Parameters: columns, unit, number of samples, whether text, and values by name; preferred, the one with the times.
    """
    heads = {name: headed(name, columns[name][0]) for name in columns}

    def clock(wanted: str) -> Clock | None:
        named = [name for name in columns if wanted in (name, heads[name][0])]
        if not named and wanted == CLOCKS[0]:
            likely = [name for name in columns if name == preferred or heads[name][0].lower() in CLOCKS]
            named = likely[:1]
        return Clock(named[0], heads[named[0]][1], columns[named[0]][3]()) if len(named) == 1 else None

    return [
        Series(
            heads[name][0],
            heads[name][1],
            samples,
            values,
            clock,
            is_text=is_text,
            aliases=(name,) if name != heads[name][0] else (),
        )
        for name, (_, samples, is_text, values) in columns.items()
    ]


def numbers(values: Any) -> Array:
    """Samples as doubles."""
    return np.asarray(values, dtype=float)
