"""Inequalities and equations as rows, in shares of their scale."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from clutchwork.base.arrays import Array

if TYPE_CHECKING:
    from clutchwork.calibration.evaluate import Evaluation
    from clutchwork.calibration.limits import Settled

# a goal that is a smaller share of that at the start is none: what is left of its gradient is measured by the start's
NOTHING = 1e-6


def measure(goal: float, start: float = 1.0) -> float:
    """What the gradient of a goal is compared with: the goal, or that at the start where nothing is left of it."""
    return abs(goal) if abs(goal) > NOTHING * start else start or 1.0


class Row(NamedTuple):
    """One inequality or equation: a value of one sample against a bound."""

    sample: int
    row: int
    bound: float
    sign: float  # 1 for an upper bound, -1 for a lower one, 0 for an equation
    scale: float
    limit: int  # number of the limit that it is of, -1 for the worst of the goal


def rows_of(limit: Settled, number: int, part: slice, scale: float) -> Iterator[Row]:
    """The rows of a limit in the first sample."""
    for row in range(part.start, part.stop):
        if limit.is_equal:
            yield Row(0, row, limit.upper, 0.0, scale, number)
            continue
        for bound, sign in ((limit.upper, 1.0), (limit.lower, -1.0)):
            if np.isfinite(bound):
                yield Row(0, row, bound, sign, scale, number)


def size_of(limit: Settled) -> float:
    """The larger of its bounds."""
    return max(abs(one) for one in (limit.lower, limit.upper) if np.isfinite(one))


class ConstraintBlock:
    """Rows as arrays: what must not be negative, or must be zero in equations."""

    def __init__(self, rows: Sequence[Row]) -> None:
        table = np.array(rows, dtype=float).reshape(-1, len(Row._fields))
        self.rows = tuple(rows)
        self.samples, self.places = table[:, 0].astype(np.intp), table[:, 1].astype(np.intp)
        self.bounds, self.scales = table[:, 2], table[:, 4]
        self.equal = table[:, 3] == 0.0
        self.signs = np.where(self.equal, -1.0, table[:, 3])
        self.goal = table[:, 5] < 0.0

    def values(self, point: Evaluation, y: Array) -> Array:
        """At scaled unknowns."""
        found = point.values[self.samples, self.places]
        made: Array = self.signs * (self.bounds - found) / self.scales
        return np.where(self.goal, y[-1] - found / self.scales, made)

    def slopes(self, point: Evaluation, width: Array, count: int) -> Array:
        """Their derivatives by the scaled unknowns."""
        made = np.zeros((len(self.rows), count))
        factor = -(self.signs / self.scales)[:, None]
        made[:, : len(width)] = factor * point.slopes[self.samples, self.places] * width
        made[self.goal, -1] = 1.0
        return made
