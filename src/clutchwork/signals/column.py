"""Column of a CSV file over time."""

from __future__ import annotations

import csv
from dataclasses import field
from functools import cached_property
from math import isfinite
from pathlib import Path

from clutchwork.errors import FileError, near
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
    def points(self) -> tuple[tuple[float, float], ...]:
        """(time, value) pairs as read from the file."""
        path = Path(self.folder, self.path)
        try:
            with path.open(newline="", encoding="utf-8-sig") as stream:
                lines = list(csv.reader(stream))
        except FileNotFoundError:
            raise FileError("path", f"{self.path!r} does not exist", f"put the file into {path.parent}") from None
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise FileError("path", f"{self.path!r} cannot be read: {error}", "give a CSV text file") from None
        return tuple((t, self.scale * y) for t, y in self._pairs(lines))

    def _pairs(self, lines: list[list[str]]) -> list[tuple[float, float]]:
        if not lines:
            raise FileError("path", f"{self.path!r} is empty", "give a header line and at least one line of numbers")
        header = [name.strip() for name in lines[0]]
        places = [self._place(header, quantity) for quantity in ("time", "column")]
        # lines that are empty, as at the end of many files, carry nothing
        rows = [(number, line) for number, line in enumerate(lines[1:], 2) if any(cell.strip() for cell in line)]
        if not rows:
            raise FileError("path", f"{self.path!r} has no line of numbers", "give at least one line below the header")
        pairs = [
            (self._number(n, line, places[0], header), self._number(n, line, places[1], header)) for n, line in rows
        ]
        for (number, _), (t, _), (t_next, _) in zip(rows[1:], pairs, pairs[1:], strict=False):
            if t_next < t:
                where = f"line {number} of {self.path!r}: time {t_next:g} s comes after {t:g} s"
                raise FileError("time", where, "sort the file by time")
        return pairs

    def _place(self, header: list[str], quantity: str) -> int:
        name = getattr(self, quantity)
        if name in header:
            return header.index(name)
        remedy = f"the columns are {', '.join(header)}" + near(name, header)
        if len(header) == 1 and ";" in header[0]:
            remedy = "separate the columns with commas, not with semicolons"
        raise FileError(quantity, f"{self.path!r} has no column {name!r}", remedy)

    def _number(self, number: int, line: list[str], place: int, header: list[str]) -> float:
        cell = line[place].strip() if place < len(line) else ""
        try:
            # Python reads 1_0 as ten, a spreadsheet does not
            value = float(cell.replace("_", "?"))
        except ValueError:
            value = float("nan")
        if isfinite(value):
            return value
        quantity = "column" if header[place] == self.column else "time"
        where = f"line {number} of {self.path!r}, column {header[place]!r}: {cell!r} is not a finite number"
        raise FileError(quantity, where, "write a number, with a point for the decimals")

    def problems(self) -> list[tuple[str, str, str]]:
        """What is wrong with the file, as (quantity, what is wrong, remedy)."""
        try:
            _ = self.points
        except FileError as problem:
            return [(problem.quantity, problem.message, problem.remedy)]
        return []

    def segments(self) -> tuple[Segment, ...]:
        """One linear piece between every two times, constant ones outside."""
        return tuple(pieces(self.points))
