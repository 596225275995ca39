"""Column of a CSV file over time."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from pathlib import Path
from typing import Any

from clutchwork.errors import FileError
from clutchwork.node import Segment, Signal
from clutchwork.schema import Role, component, param, text
from clutchwork.signals.table import pieces


@component(Role.SIGNAL)
class Column(Signal):
    """Measured or prepared values: one column of a CSV file, linear over its time column, held outside.

    The first line of the file names the columns; the separator is a comma. Equal times make a jump.
    In a model file the path is relative to that file. A file that cannot be used raises `FileError`.
    """

    path: str = text("path of the CSV file", kw_only=False)
    column: str = text("name of the column with the values", kw_only=False)
    time: str = text("name of the column with the times [s]", default="time", kw_only=False)
    scale: float = param("1", "factor on the values, 1e5 for a file in bar", default=1.0)
    folder: str = field(default="", kw_only=True, repr=False, compare=False)

    @cached_property
    def _table(self) -> Any:
        """Times and values as read from the file, a row each."""
        # numpy is no need of the build, which imports this declaration
        from clutchwork.column_file import Wanted, read

        return read(Path(self.folder, self.path), Wanted(self.path, self.time, self.column), self.scale)

    @cached_property
    def points(self) -> tuple[tuple[float, float], ...]:
        """(time, value) pairs as read from the file."""
        return tuple(map(tuple, self._table.tolist()))

    @cached_property
    def _pieces(self) -> tuple[Segment, ...]:
        return tuple(pieces(self.points))

    def problems(self) -> list[tuple[str, str, str]]:
        """What is wrong with the file, as (quantity, what is wrong, remedy)."""
        try:
            _ = self._table
        except FileError as error:
            return error.problems
        return []

    def segments(self) -> tuple[Segment, ...]:
        """One linear piece between every two times, constant ones outside."""
        return self._pieces
