"""Values of rows that are looked at at knots and at the end: which numbers move one that is at a border there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.gradients.knots import times_of

if TYPE_CHECKING:
    from clutchwork.gradients.run_point import Run, RunPoint
    from clutchwork.gradients.words import Chart

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Places = NDArray[np.intp]

# so near to a border a value rests there, of what numbers change it by, and of the relative tolerance of the run
NEAR, BY_TOLERANCE = 1e-9, 1.0
# at so many knots it is looked at
MOST_KNOTS = 1000


@dataclass(frozen=True, eq=False)
class Distance:
    """How far a sum of numbers of a row is from a border that is made of words."""

    columns: Places
    shares: Array
    words: Places  # whose sum is taken off
    signs: Array


def knots_and_end(chart: Chart, words: Array, begin: float, end: float) -> tuple[float, ...]:
    """Knots inside of a run, the first ones, and its end [s]."""
    return (*[time for time in times_of(chart, words, end) if begin < time < end][:MOST_KNOTS], end)


def moved(point: RunPoint, run: Run, one: Distance, time: float) -> Mask:
    """Numbers that move a distance which is zero at an instant [s]."""
    primal = run.primal
    own = primal.rows[:, one.columns] @ one.shares - point.words[one.words] @ one.signs
    # of a sum, the largest of what it is made of
    size = float((np.abs(primal.rows[:, one.columns]) @ np.abs(one.shares)).max(initial=0.0))
    here, allowed = abs(float(own[primal.row(time)])), max(NEAR, BY_TOLERANCE * primal.rtol)
    if here > allowed * max(size, 1.0):
        return np.zeros(len(point.x), dtype=bool)
    moves = primal.functional()
    moves.add(np.array([primal.row(time)]), one.columns, one.shares[None])
    changes = np.abs(run.slope(moves) - one.signs @ point.slopes.of(one.words)) * point.sizes
    # what dies away has derivatives that do so too
    found: Mask = (changes > NEAR * size) & (here <= allowed * changes)
    return found


def distance(
    columns: Sequence[int], shares: Sequence[float], words: Sequence[int] = (), signs: Sequence[float] = ()
) -> Distance:
    """A distance from its parts."""
    return Distance(np.array(columns, dtype=np.intp), np.array(shares), np.array(words, dtype=np.intp), np.array(signs))
