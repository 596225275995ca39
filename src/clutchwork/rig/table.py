"""A table of results: named columns with units, to print and to write."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeAlias

from clutchwork.base import columns, dataclass, near
from clutchwork.base.paths import fitting
from clutchwork.base.writing import put_csv

Cell: TypeAlias = "float | str"


@dataclass(frozen=True)
class TableColumn:
    """Head of a column: what it holds and its unit; empty for words."""

    name: str
    unit: str = ""

    @property
    def head(self) -> str:
        """`name [unit]`."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True)
class Table:
    """Lines of numbers and words under named columns; print it to read it. NaN stands for what was not reached."""

    columns: tuple[TableColumn, ...]
    lines: tuple[tuple[Cell, ...], ...]

    def __getitem__(self, name: str) -> list[Cell]:
        """One column; KeyError with a near match for an unknown name."""
        place = self._place(name)
        return [line[place] for line in self.lines]

    def value(self, line: str, name: str) -> float:
        """The number in the line whose first cell is `line`, in the column of that name."""
        firsts = [str(cells[0]) for cells in self.lines]
        if line not in firsts:
            raise KeyError(f"no line {line!r}{near(line, firsts)}")
        return float(self.lines[firsts.index(line)][self._place(name)])

    def to_csv(self, path: str | Path) -> None:
        """Write it with the heads `name [unit]` and all digits."""
        lines = [[repr(c) if isinstance(c, float) else c for c in line] for line in self.lines]
        put_csv(fitting("to_csv", path, "table.csv"), [[column.head for column in self.columns], *lines])

    def to_dict(self) -> list[dict[str, Any]]:
        """One mapping `head: value` for each line; NaN becomes None, which JSON knows."""
        heads = [column.head for column in self.columns]
        return [dict(zip(heads, [_plain(cell) for cell in line], strict=True)) for line in self.lines]

    def _place(self, name: str) -> int:
        names = [column.name for column in self.columns]
        if name not in names:
            rest = f"columns: {', '.join(names)}"
            raise KeyError(f"no column {name!r}{near(name, names, rest)}")
        return names.index(name)

    def __str__(self) -> str:
        head = [column.head for column in self.columns]
        numbers = {i for i in range(len(head)) if any(isinstance(line[i], float) for line in self.lines)}
        return columns([head, *([_read(cell) for cell in line] for line in self.lines)], right=numbers)


def words(head: str, lines: Sequence[tuple[str, str]]) -> Table:
    """A table of two columns of words."""
    return Table((TableColumn(head), TableColumn("what it is")), tuple(lines))


def _read(cell: Cell) -> str:
    if isinstance(cell, str):
        return cell
    return "-" if math.isnan(cell) else f"{cell:.4g}"


def _plain(cell: Cell) -> Any:
    return None if isinstance(cell, float) and not math.isfinite(cell) else cell
