"""Tables on common grids: a linear table on a finer grid is the same table."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from clutchwork.declare import Found

Pairs = Sequence[tuple[float, float]]


class Grid(NamedTuple):
    """Values over two quantities, a row for each of the first."""

    rows: Sequence[float]
    columns: Sequence[float]
    values: Sequence[Sequence[float]]


def points_of(given: Any) -> Pairs:
    """The points of a curve; a number is the same everywhere."""
    return given if hasattr(given, "__len__") else ((0.0, float(given)),)


def union(*grids: Iterable[float]) -> tuple[float, ...]:
    """All numbers of several grids that are not negative, once and in order."""
    return tuple(sorted({float(x) for grid in grids for x in grid if x >= 0.0}))


def at_each(points: Pairs, grid: Iterable[float]) -> tuple[float, ...]:
    """Values of a curve on a grid, linear between its points and held outside."""
    xs, ys = [x for x, _ in points], [y for _, y in points]
    return tuple(_between(xs, ys, x) for x in grid)


def resampled(given: Grid, rows: Sequence[float], columns: Sequence[float]) -> tuple[tuple[float, ...], ...]:
    """Bilinear values on finer grids, held outside."""
    across = [[_between(given.columns, row, x) for x in columns] for row in given.values]
    return tuple(
        tuple(_between(given.rows, [line[k] for line in across], x) for k in range(len(columns))) for x in rows
    )


def _between(xs: Sequence[float], ys: Sequence[float], x: float) -> float:
    k = bisect_right(xs, x)
    if k in (0, len(xs)):
        return float(ys[0] if k == 0 else ys[-1])
    # a point of the table is met to the last bit
    share = (x - xs[k - 1]) / (xs[k] - xs[k - 1])
    return float(ys[k - 1] + (ys[k] - ys[k - 1]) * share)


def shape_problems(name: str, values: Any, rows: Any, columns: Any) -> Found:
    """Too few or too many rows or columns, as (quantity, what is wrong, remedy)."""
    if len(values) == len(rows) and all(len(row) == len(columns) for row in values):
        return []
    shape = f"{len(values)} rows of {sorted({len(row) for row in values})} numbers"
    fault = f"has {shape}, must have {len(rows)} rows of {len(columns)} numbers"
    return [(name, fault, "give a row for each number of its first axis")]
