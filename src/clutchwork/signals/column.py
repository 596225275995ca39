"""Column of a file over time."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from os.path import join
from typing import Any

from clutchwork.base import FileError
from clutchwork.declare import Role, Segment, Signal, component, param, text
from clutchwork.declare.quantity import QuantityError
from clutchwork.signals.table import pieces


@component(Role.SIGNAL)
class Column(Signal):
    """Measured or prepared values: one column of a file, linear over its times, held outside.

    The file is CSV, MDF (INCA, CANape), MAT (MATLAB), Parquet or NetCDF; `cw.read_columns(path)` lists what it holds.
    Equal times make a jump. Values with a unit are converted to SI, and so are times; it must fit the driven
    quantity. Without a unit they are in SI. The first line of a CSV file names the columns, with units such as
    `c1 [bar]` or `oil [degC]`; the separator is a comma. A name without its unit finds that column too. A channel of
    an MDF file has the times of its group, a vector of a MAT file those named `time` or `t` beside it, or in a
    structure around it.
    In a model file the path is relative to that file. A file that cannot be used raises `FileError`.
    """

    path: str = text("path of the file", kw_only=False)
    column: str = text("name of the column with the values", kw_only=False)
    time: str = text("name of the column with the times", default="time", kw_only=False)
    scale: float = param(
        "1", "factor on the values in SI; 1e5 for values in bar below a head without a unit", default=1.0
    )
    group: str | None = text("group of the channel, where an MDF file has several of its name", default=None)
    folder: str = field(default="", kw_only=True, repr=False)

    @cached_property
    def _read(self) -> Any:
        """Times and values of the file in SI, a row each, and the head of the column."""
        # numpy is no need of the build, which imports this declaration
        from clutchwork.signals.bases.column_file import ColumnRequest
        from clutchwork.signals.bases.measured.reading import read

        wanted = ColumnRequest(self.path, self.time, self.column, self.scale, self.group or "")
        # a Path takes longer than a column of a file that is known
        return read(join(self.folder, self.path), wanted)  # noqa: PTH118

    @cached_property
    def points(self) -> tuple[tuple[float, float], ...]:
        """(time, value) pairs of the file, in SI."""
        return tuple(map(tuple, self._read.table.tolist()))

    @cached_property
    def _pieces(self) -> tuple[Segment, ...]:
        return tuple(pieces(self.points))

    def problems(self) -> list[tuple[str, str, str]]:
        """What is wrong with the file, as (quantity, what is wrong, remedy)."""
        try:
            _ = self._read
        except FileError as error:
            return error.problems
        return []

    def unit_problems(self, units: tuple[str, ...]) -> list[tuple[str, str, str]]:
        """A head whose unit fits none of those that the driven quantity may have."""
        try:
            _ = self._read.head.scale(units)
        except FileError:
            # its mistakes are reported as those of the file
            return []
        except QuantityError as bad:
            return [("column", f"{bad.value} {bad.message}", bad.remedy)]
        return []

    def unit(self) -> str:
        """The unit that the head of the column says; empty where it says none, or the file cannot be used."""
        try:
            return str(self._read.head.unit)
        except FileError:
            return ""

    def segments(self) -> tuple[Segment, ...]:
        """One linear piece between every two times, constant ones outside."""
        return self._pieces
