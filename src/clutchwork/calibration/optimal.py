"""Whether a point is optimal, and what each active limit costs: multipliers by least squares with the right signs.

docs/theory/calibration.md (4), whatever solver found the point.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.calibration.rows import ConstraintBlock, Row

if TYPE_CHECKING:
    from clutchwork.calibration.scaled import Scaled

# limits and bounds that are closer than this are active, in scaled numbers
CLOSE = 1e-5


@dataclass(frozen=True)
class Active:
    """A limit that holds the goal up."""

    row: Row
    multiplier: float  # derivative of the least goal by the bound, both in SI: of an upper one it is negative


@dataclass(frozen=True)
class Certificate:
    """What holds at a point."""

    violation: float  # of the worst limit, in shares of its scale
    residual: float  # what is left of the gradient of the goal, in shares of the goal over the ranges of the unknowns
    active: tuple[Active, ...]
    at_bounds: tuple[tuple[int, float, float], ...]  # unknown, side (-1 or 1), multiplier by its unit


def certificate(scaled: Scaled, y: Array) -> Certificate:
    """Of scaled unknowns."""
    count, own = scaled.count, len(scaled.width)
    matrix, ends = scaled.linear
    block = ConstraintBlock(scaled.rows)
    values = np.concatenate([scaled.values(y, block), ends - matrix @ y])
    slopes = np.vstack([scaled.slopes(y, block), -matrix])
    rows = [*block.rows, *scaled.flat.rows]
    equal = np.array([one.sign == 0.0 for one in rows], dtype=bool)
    violation = float(np.max(np.where(equal, np.abs(values), -values), initial=0.0))
    near = np.flatnonzero(equal | (values <= CLOSE))
    columns = [slopes[near].T, -slopes[near[equal[near]]].T]
    edges = [(k, side) for k in range(own) for side, gap in ((-1.0, y[k]), (1.0, 1.0 - y[k])) if gap <= CLOSE]
    walls = np.zeros((count, len(edges)))
    for column, (k, side) in enumerate(edges):
        walls[k, column] = -side
    gradient = scaled.gradient(y)
    normals = np.hstack([*columns, walls])
    nnls = need("scipy.optimize", "calibrate", "calibrate").nnls
    # nnls of SciPy 1.17 corrupts memory where there are no columns
    found = nnls(normals, gradient)[0] if normals.shape[1] else np.zeros(0)
    left = gradient - normals @ found
    both = found[: len(near)].copy()
    both[equal[near]] -= found[len(near) : len(near) + np.count_nonzero(equal[near])]
    goal = scaled.goal_scale
    active = tuple(
        Active(rows[place], -(rows[place].sign or -1.0) * float(factor) * goal / rows[place].scale)
        for place, factor in zip(near, both, strict=True)
        if factor != 0.0
    )
    at_bounds = tuple(
        (k, side, float(factor) * goal / float(scaled.width[k]))
        for (k, side), factor in zip(edges, found[len(found) - len(edges) :], strict=True)
    )
    return Certificate(violation, float(np.max(np.abs(left), initial=0.0)), active, at_bounds)
