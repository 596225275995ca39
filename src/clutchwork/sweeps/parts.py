"""Rows that cut each step of the solver into equal parts, and what the polynomials through them give."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

# rows in every step of the solver, the last one at its end
PARTS = 4
# steps in which times of rows may coincide [s]
SHORT = 1e-13


def in_parts(times: Array) -> Array:
    """Instants that cut each step into equal parts, from the bare steps of a run; those at events appear twice."""
    begins, ends = times[:-1], times[1:]
    long = ends > begins
    inner = begins[long, None] + np.arange(1, PARTS) / PARTS * (ends - begins)[long, None]
    return np.sort(np.concatenate([times, inner.ravel()]))


def steps_of(times: Array) -> NDArray[np.intp]:
    """Numbers of the rows at which a step begins; the rows of it are this one and the next `PARTS`.

    The start of a smooth phase has a row of its own, at the time of the row before.
    """
    firsts = np.flatnonzero(np.r_[True, times[1:] <= times[:-1]])[: len(times)]
    lengths = np.diff(np.r_[firsts, len(times)]) - 1
    if np.any(lengths % PARTS):
        found = _one_by_one(times)
    else:
        counts = lengths // PARTS
        within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        found = np.repeat(firsts, counts) + PARTS * within
    long: NDArray[np.intp] = found[times[found + PARTS] > times[found]]
    return long


def _one_by_one(times: Array) -> NDArray[np.intp]:
    """The same where a step is so short that rows inside of it have one time."""
    found, at, last = list[int](), 0, len(times) - 1
    while at + PARTS <= last:
        starts_anew = times[at + 1] <= times[at]
        if starts_anew and times[at + PARTS] - times[at] > SHORT * (1.0 + abs(times[at])):
            at += 1
            continue
        found.append(at)
        at += PARTS
    return np.array(found, dtype=np.intp)


def squared_jerk_of(times: Array, acceleration: Array) -> float:
    """Integral of the square of the rate of an acceleration over the steps: docs/theory/gradients.md (15)."""
    begins = steps_of(times)
    values = acceleration[begins[:, None] + np.arange(PARTS + 1)]
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
