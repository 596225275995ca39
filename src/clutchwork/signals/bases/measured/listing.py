"""Content of a file of measurements, before a column of it is used."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import overload

from clutchwork.base import FileError, columns, dataclass, quote
from clutchwork.base.paths import path_of
from clutchwork.base.regular import open_regular, reason
from clutchwork.declare.calls import explained
from clutchwork.signals.bases.column_file import MOST_BYTES, as_text
from clutchwork.signals.bases.column_heads import split
from clutchwork.signals.bases.measured.formats import format_of, opened
from clutchwork.signals.bases.semicolons import with_commas


@dataclass(frozen=True)
class FileColumn:
    """One column, channel or variable of a file."""

    name: str
    unit: str  # as `Column` reads it, empty where the file says none
    samples: int
    group: str  # for `Column(group=)`, where a file has several of one name
    is_text: bool  # words, which no signal can follow
    aliases: tuple[str, ...] = ()  # shorter names that find it too


class FileColumns(Sequence[FileColumn]):
    """Content of a file, in its order; print it to see it."""

    def __init__(self, found: Sequence[FileColumn]) -> None:
        self._found = tuple(found)

    @overload
    def __getitem__(self, index: int) -> FileColumn: ...
    @overload
    def __getitem__(self, index: slice) -> FileColumns: ...
    def __getitem__(self, index: int | slice) -> FileColumn | FileColumns:
        return FileColumns(self._found[index]) if isinstance(index, slice) else self._found[index]

    def __len__(self) -> int:
        return len(self._found)

    def __iter__(self) -> Iterator[FileColumn]:
        return iter(self._found)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all columns."""
        return tuple(one.name for one in self)

    def __str__(self) -> str:
        """A table for reading."""
        lines = [(one.name, "text" if one.is_text else one.unit, str(one.samples), one.group) for one in self]
        return columns([("column", "unit", "samples", "group"), *lines], right={2}) if lines else "no columns"

    __repr__ = __str__


@explained("cw.read_columns", path="'measured.mf4'")
def read_columns(path: str | Path) -> FileColumns:
    """List the columns of a file of measurements for `cw.Column`: names, units, numbers of samples, groups.

    Parameters: path of a CSV, MDF, MAT, Parquet or NetCDF file. FileError, a ValueError, where it cannot be read.
    """
    where, told = path_of("cw.read_columns", path, "measured.mf4"), str(path)
    try:
        form = format_of(where)
        if form:
            with opened(where, form, told) as found:
                return FileColumns(
                    [FileColumn(one.name, one.unit, one.samples, one.group, one.is_text, one.aliases) for one in found]
                )
        return FileColumns(_of_csv(where))
    except FileNotFoundError:
        raise FileError([("path", f"{quote(told)} does not exist", "check the path")]) from None
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        why = reason(error) if isinstance(error, OSError) else "it is not UTF-8 text"
        raise FileError([("path", f"{quote(told)} cannot be read: {why}", "give a file of measurements")]) from None


def _of_csv(path: Path) -> list[FileColumn]:
    with open_regular(path, MOST_BYTES) as file, with_commas(file) as plain, as_text(plain) as text:
        lines = csv.reader(text)
        heads = [split(head.strip()) for head in next(lines, [])]
        samples = sum(1 for line in lines if any(line))
    return [FileColumn(name, unit, samples, "", is_text=False) for name, unit in heads]
