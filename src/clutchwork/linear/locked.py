"""The motion that locked contacts leave: docs/theory/linearisation.md (4)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array

# what is left of a row after elimination, beside the row, that counts as round-off
ROUND_OFF = 1e-10
# a pivot is at least this part of the largest number of its row
LEAST_PIVOT = 0.1


@dataclass(frozen=True, eq=False)
class Free:
    """Speeds over those that are kept and the prescribed ones: v = Z x + Zp p, with B v + beta p = 0 for all x."""

    kept: NDArray[np.intp]  # independent speeds that stay, in the order of preference
    Z: Array
    Zp: Array
    ties: Array  # rows over the prescribed speeds that must stay zero: contacts lock these to each other


def free_motion(B: Array, beta: Array, preference: Sequence[int]) -> Free:
    """Eliminate one speed per independent row of B v + beta p = 0; those that come early in `preference` stay."""
    n, prescribed = B.shape[1], beta.shape[1]
    rank_of = np.empty(n, dtype=int)
    rank_of[np.asarray(preference, dtype=int)] = np.arange(n)
    rows, sizes = np.hstack([B, beta]).astype(float), np.max(np.abs(B), axis=1, initial=0.0)
    left, pivots = list(range(len(rows))), dict[int, int]()
    while left:
        row = max(left, key=lambda i: float(np.max(np.abs(rows[i, :n]), initial=0.0) / (sizes[i] or 1.0)))
        largest = float(np.max(np.abs(rows[row, :n]), initial=0.0))
        if largest <= ROUND_OFF * sizes[row]:
            break
        candidates = np.flatnonzero(np.abs(rows[row, :n]) >= LEAST_PIVOT * largest)
        column = int(max(candidates, key=lambda c: rank_of[c]))
        rows[row] /= rows[row, column]
        for other in range(len(rows)):
            if other != row:
                rows[other] -= rows[other, column] * rows[row]
                rows[other, column] = 0.0
        pivots[column] = row
        left.remove(row)
    kept = np.array([i for i in preference if i not in pivots], dtype=int)
    Z, Zp = np.zeros((n, len(kept))), np.zeros((n, prescribed))
    Z[kept, np.arange(len(kept))] = 1.0
    for column, row in pivots.items():
        Z[column], Zp[column] = -rows[row, kept], -rows[row, n:]
    ties = [rows[i, n:] for i in left if np.max(np.abs(rows[i, n:]), initial=0.0) > ROUND_OFF]
    return Free(kept, Z, Zp, np.array(ties).reshape(len(ties), prescribed))
