"""Rows that cut each step of the solver into equal parts, and the squared jerk of the polynomials through them."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.arrays import Places

Array = NDArray[Any]

# rows in every step of the solver, the last one at its end
PARTS = 4
# steps that have no rows inside, of a second or of the time, as in the core
SHORT = 1e-12


def in_parts(times: Array) -> tuple[Array, Places]:
    """Instants that cut each step into equal parts, from the bare steps of a run, and the place at which each begins.

    Those at events appear twice. Steps too short to be cut are left out.
    """
    begins, ends = times[:-1], times[1:]
    long = ends - begins > SHORT * (1.0 + np.abs(ends))
    inner = begins[long, None] + np.arange(1, PARTS) / PARTS * (ends - begins)[long, None]
    places = np.flatnonzero(long) + (PARTS - 1) * np.arange(long.sum())
    return np.insert(times, np.repeat(np.flatnonzero(long) + 1, PARTS - 1), inner.ravel()), places


def steps_of(times: Array) -> Places:
    """Numbers of the rows at which a step begins; the rows of it are this one and the next `PARTS`.

    Parameters: times, of the rows that the core gives. A row behind a jump stands at the time of the row before.
    """
    ends = np.append(np.flatnonzero(times[1:] <= times[:-1]) + 1, len(times))
    firsts = np.append(0, ends[:-1])[: len(times)]
    counts = (ends[: len(firsts)] - firsts - 1) // PARTS
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    found: Places = np.repeat(firsts, counts) + PARTS * within
    return found


def squared_jerk(times: Array, acceleration: Array, begins: Places) -> float:
    """Integral of the square of the rate of an acceleration over the steps: docs/theory/gradients.md (15)."""
    values = acceleration[begins[:, None] + np.arange(PARTS + 1)]
    nodes, weights = rates()
    # what is common to all rows has no rate, but round-off
    slopes = (values - values[:, PARTS // 2, None]) @ nodes.T
    return float(np.sum(slopes**2 @ weights / (times[begins + PARTS] - times[begins])))


@cache
def rates() -> tuple[Array, Array]:
    """Slopes at Gauss points of [0, 1] of the polynomials that are one at a row and zero at others, and weights."""
    points, weights = np.polynomial.legendre.leggauss(PARTS)
    basis = np.linalg.inv(np.vander(np.arange(PARTS + 1) / PARTS, increasing=True))
    powers = np.arange(1, PARTS + 1)
    return np.vander(0.5 + 0.5 * points, PARTS, increasing=True) * powers @ basis[1:], 0.5 * weights
