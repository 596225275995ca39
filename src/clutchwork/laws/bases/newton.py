"""A root of a few equations, without numpy: declarations are read before anything is installed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite

Vector = list[float]
STEPS, NEAR, MOVE = 30, 1e-9, 1e-7


def root(function: Callable[[Vector], Vector], start: Sequence[float]) -> Vector | None:
    """Root of a square system by Newton's method; None if it does not converge."""
    x, size = list(start), 0.0
    for _ in range(STEPS):
        value = function(x)
        if not all(map(isfinite, value)):
            return None
        size = max(size, *map(abs, value))
        if max(map(abs, value)) <= NEAR * size:
            return x
        step = _solved([_slope(function, x, i, value) for i in range(len(x))], value)
        if step is None:
            return None
        x = [old - move for old, move in zip(x, step, strict=True)]
    return None


def _slope(function: Callable[[Vector], Vector], x: Vector, i: int, value: Vector) -> Vector:
    """Derivatives by one number."""
    move = MOVE * max(abs(x[i]), 1e-3)
    moved = function([old + move * (j == i) for j, old in enumerate(x)])
    return [(new - old) / move for new, old in zip(moved, value, strict=True)]


def _solved(columns: Sequence[Vector], right: Vector) -> Vector | None:
    """Gaussian elimination: solves columns times x = right side."""
    n = len(right)
    rows = [[column[i] for column in columns] + [right[i]] for i in range(n)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        if not abs(rows[pivot][k]) > 0.0:
            return None
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [one / rows[k][k] for one in rows[k]]
        for i in range(n):
            if i != k:
                rows[i] = [a - rows[i][k] * b for a, b in zip(rows[i], rows[k], strict=True)]
    return [row[n] for row in rows]
