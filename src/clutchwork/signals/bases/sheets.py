"""Small CSV files that are read once as a whole, while several columns of them are asked for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import field
from itertools import chain

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array

# of the text of a file that is kept as numbers
MOST_BYTES = 1 << 20


@dataclass(frozen=True)
class NumericSheet:
    """The columns of a file whose cells are all finite numbers."""

    header: list[str]
    table: Array
    _plain: dict[int, bool] = field(default_factory=dict)

    def is_plain(self, time: int) -> bool:
        """Whether the times in a column never fall, and no value changes too fast over them to be computed with."""
        if time not in self._plain:
            with np.errstate(all="ignore"):
                steps = np.diff(self.table, axis=0)
                width = steps[:, time : time + 1]
                slopes = np.divide(steps, width, out=np.zeros_like(steps), where=width > 0.0)
            self._plain[time] = bool(np.all(width >= 0.0) and np.all(np.isfinite(slopes)))
        return self._plain[time]


_SHEETS: ContextVar[dict[str, NumericSheet] | None] = ContextVar("sheets", default=None)


@contextmanager
def one_reading() -> Iterator[None]:
    """Files that are read inside are read in one state."""
    token = _SHEETS.set({})
    try:
        yield
    finally:
        _SHEETS.reset(token)


def known(where: str) -> NumericSheet | None:
    """The sheet of the file at a path that was read before."""
    return (_SHEETS.get() or {}).get(where)


def keep(where: str, size: int, header: list[str], lines: Iterator[list[str]]) -> NumericSheet | None:
    """The sheet of a file, kept for the next column; None if it has other cells, or no further column is read."""
    sheets = _SHEETS.get()
    if sheets is None or size > MOST_BYTES:
        return None
    try:
        rows = [line for line in lines if line]
        table = np.fromiter(map(float, chain.from_iterable(rows)), float).reshape(len(rows), len(header))
    except ValueError:
        return None
    if not len(table) or not np.all(np.isfinite(table)):
        return None
    made = sheets[where] = NumericSheet(header, table)
    return made
