"""Other solutions that are as good as the best one: what is open may take more with it than a tangent shows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import log
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.fit.intervals import Estimate, limits_at
from clutchwork.fit.reasons import spans

if TYPE_CHECKING:
    from clutchwork.fit.engine import Solution
    from clutchwork.fit.search import Residuals


# how far a parameter that is open is moved: a factor, or so many times its scale
FACTOR, SCALES = 10.0, 3.0


def widened(search: Residuals, best: Solution, found: Estimate) -> Estimate:
    """Intervals that hold what all parameters become when one that is open is moved and the others follow."""
    items, limits, why = search.unknowns.items, list(found.limits), list(found.reasons)
    for column, place in enumerate(search.unknowns.searched):
        if not found.reasons[place]:
            continue
        others = np.setdiff1d(np.arange(len(best.u)), column)
        for u in _elsewhere(search, best, found, column) if len(others) else ():
            there = limits_at(search, u, found.tolerance, others)
            limits = [(min(a[0], b[0]), max(a[1], b[1])) for a, b in zip(limits, there, strict=True)]
        for other, item in enumerate(items):
            if not why[other] and spans(item, limits[other]):
                why[other] = f"it moves with {items[place].name}, which is open"
    return replace(found, limits=limits, reasons=why)


def _elsewhere(search: Residuals, best: Solution, found: Estimate, column: int) -> Iterator[Array]:
    """Solutions as good as the best one, with one code somewhere else."""
    far = log(FACTOR) if search.logs[column] else SCALES * float(search.scales[column])
    here, start = float(best.u[column]), float(search.unknowns.start[column])
    low, high = float(search.unknowns.lower[column]), float(search.unknowns.upper[column])
    for code in (start, here - far, here + far):
        moved = best.u.copy()
        moved[column] = min(max(code, low), high)
        other = search.solve(moved, held=[column])
        if other.squares <= best.squares + found.tolerance:
            yield other.u
