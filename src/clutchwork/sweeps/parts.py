"""Rows that cut each step of the solver into equal parts, and what the polynomials through them give."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

# rows in every step of the solver, the last one at its end
PARTS = 4


def in_parts(times: Array) -> Array:
    """Instants that cut each step into equal parts, from the bare steps of a run; those at events appear twice."""
    begins, ends = times[:-1], times[1:]
    long = ends > begins
    inner = begins[long, None] + np.arange(1, PARTS) / PARTS * (ends - begins)[long, None]
    return np.sort(np.concatenate([times, inner.ravel()]))


def steps_of(times: Array) -> NDArray[np.intp]:
    """Numbers of the rows at which a step begins; the rows of it are this one and the next `PARTS`."""
    firsts = np.flatnonzero(np.r_[True, times[1:] <= times[:-1]])[: len(times)]
    counts = (np.diff(np.r_[firsts, len(times)]) - 1) // PARTS
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    found = np.repeat(firsts, counts) + PARTS * within
    long: NDArray[np.intp] = found[times[found + PARTS] > times[found]]
    return long


def squared_jerk_of(times: Array, acceleration: Array) -> float:
    """Integral of the square of the rate of an acceleration over the steps: docs/theory/gradients.md (5)."""
    begins = steps_of(times)
    # from the first row on: slopes of short steps would drown in the rounding of large values
    values = acceleration[begins[:, None] + np.arange(PARTS + 1)] - acceleration[begins, None]
    return float(np.sum(np.einsum("ki,ij,kj->k", values, form(), values) / (times[begins + PARTS] - times[begins])))


@cache
def basis() -> Array:
    """Coefficients of the polynomials over [0, 1] that are one at a point of a step and zero at its other ones."""
    points = np.arange(PARTS + 1) / PARTS
    return np.linalg.inv(np.vander(points, increasing=True))


@cache
def form() -> Array:
    """The integral of the product of the slopes of two of them."""
    powers, slopes = np.arange(PARTS), np.arange(1, PARTS + 1)[:, None] * basis()[1:]
    found: Array = slopes.T @ (1.0 / (powers[:, None] + powers + 1.0)) @ slopes
    return found
