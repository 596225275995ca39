"""Exact arithmetic for the kinematics: fractions of the decimal numbers that the user wrote."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

Row = list[Fraction]


def exact(value: float | Fraction) -> Fraction:
    """The decimal number as written: 2.78 becomes 278/100, not its binary neighbour."""
    return value if isinstance(value, Fraction) else Fraction(repr(float(value)))


@dataclass(frozen=True)
class Reduced:
    """Rows after elimination.

    `pivots[i]` is the column that `rows[i]` solves for: its entry there is 1, and 0 in all other rows.
    `origin[i]` says which sum of the given rows it is; `spare` are the sums that came out as zero.
    """

    rows: list[Row]
    pivots: list[int]
    origin: list[Row]
    spare: list[Row]


def eliminate(rows: Sequence[Sequence[Fraction]], order: Sequence[int]) -> Reduced:
    """Gauss-Jordan elimination that solves for the columns in the given order where it can."""
    table = [list(row) for row in rows]
    origin = [[Fraction(int(i == j)) for j in range(len(table))] for i in range(len(table))]
    pivots: list[int] = []
    for column in order:
        done = len(pivots)
        found = next((i for i in range(done, len(table)) if table[i][column]), None)
        if found is None:
            continue
        for side in (table, origin):
            side[done], side[found] = side[found], side[done]
        scale = table[done][column]
        table[done] = [x / scale for x in table[done]]
        origin[done] = [x / scale for x in origin[done]]
        for i in range(len(table)):
            factor = table[i][column]
            if i != done and factor:
                table[i] = _minus(table[i], factor, table[done])
                origin[i] = _minus(origin[i], factor, origin[done])
        pivots.append(column)
    rank = len(pivots)
    return Reduced(table[:rank], pivots, origin[:rank], origin[rank:])


def _minus(row: Row, factor: Fraction, other: Row) -> Row:
    return [a - factor * b if b else a for a, b in zip(row, other, strict=True)]
