"""Column of a CSV file over time."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from itertools import pairwise
from math import isfinite
from pathlib import Path

from clutchwork.errors import FileError
from clutchwork.node import Segment, Signal
from clutchwork.schema import Role, component, param, text
from clutchwork.shown import shown
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
    def points(self) -> tuple[tuple[float, float], ...]:
        """(time, value) pairs as read from the file."""
        # numpy is no need of the build, which imports this declaration
        from clutchwork.column_file import Wanted, read

        table = read(Path(self.folder, self.path), Wanted(self.path, self.time, self.column))
        return tuple(zip(table[:, 0].tolist(), (self.scale * table[:, 1]).tolist(), strict=True))

    @cached_property
    def _pieces(self) -> tuple[Segment, ...]:
        return tuple(pieces(self.points))

    def problems(self) -> list[tuple[str, str, str]]:
        """What is wrong with the file, as (quantity, what is wrong, remedy)."""
        try:
            found = self.points
        except FileError as error:
            return error.problems
        steep = next(
            (a for a, b in pairwise(found) if b[0] > a[0] and not isfinite((b[1] - a[1]) / (b[0] - a[0]))), None
        )
        if steep is None and all(isfinite(y) for _, y in found):
            return []
        return [("path", f"{shown(self.path)} has values that change too fast", "leave out times that nearly coincide")]

    def segments(self) -> tuple[Segment, ...]:
        """One linear piece between every two times, constant ones outside."""
        return self._pieces
