"""Whether a corner is optimal, and a way out where it is not: gradients of the point and of its neighbours together.

The gradient jumps where a peak passes another one, or an event an instant that counts: no gradient is zero there. Where
a clutch only just locks a limit breaks at once beyond: there is a wall. docs/theory/calibration.md (7)

J. V. Burke, A. S. Lewis, M. L. Overton, A robust gradient sampling algorithm for nonsmooth, nonconvex optimization,
doi:10.1137/030601296.
"""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.calibration.optimal import CLOSE
from clutchwork.calibration.outcome import FEASIBLE, OPTIMAL
from clutchwork.calibration.rows import ConstraintBlock, measure

if TYPE_CHECKING:
    from clutchwork.calibration.evaluate import Evaluation
    from clutchwork.calibration.scaled import Scaled

# how far neighbours are, in shares of the bounds
RADIUS = 1e-3
# weight of factors that sum up to one, in the largest gradient
WHOLE = 1e2
# boxes of a step out of a corner, in shares of the bounds, and steps in all
BOXES, MOST_STEPS = (3e-2, 1e-2, 3e-3, 1e-3, 1e-4), 15
# runs that may be spent on the way out
MOST_RUNS = 1500
# steps keep off a wall by this share of their box, or less
OFF = (0.0, 0.1)
# by what share of itself a step must make the goal less; steps of less than the second are slow, and few are made
BETTER, SLOW, MOST_SLOW = 1e-5, 2e-3, 6


class Around(NamedTuple):
    """A point and its neighbours, a step to either side of each unknown."""

    residual: float  # of the least combination of their gradients, in shares of the goal over the ranges
    y: Array  # the best of them that holds all limits
    goal: float
    cuts: tuple[Array, Array]  # linear models of the goal around: values at the point, slopes
    limits: tuple[Array, Array]  # the same of what must not be negative
    walls: Array  # directions away from where a limit breaks at once


class _Cut(NamedTuple):
    """What is known at one of them, linear up to the point."""

    goal: Array
    goal_slopes: Array
    limits: Array
    limit_slopes: Array
    there: Array  # what must not be negative, at the neighbour itself
    largest: NDArray[np.bool_]  # values of the goal that are the largest one there


def around(scaled: Scaled, y: Array) -> Around | None:
    """What a point and its neighbours say together; None where too few have a gradient."""
    own, here = len(scaled.width), scaled.goal(y)
    block = ConstraintBlock([row for row in scaled.rows if row.limit >= 0])
    goal = ConstraintBlock([row for row in scaled.rows if row.limit < 0])
    cuts, best, least = list[_Cut](), y, here

    def look(one: Array) -> None:
        nonlocal best, least
        point = scaled.point(one)
        if not point.is_fine:
            return
        other = scaled.lifted(one, point)
        if scaled.goal(other) < least and _holds(scaled, point, other, block):
            best, least = other, scaled.goal(other)
        if not point.note:
            cuts.append(_cut(scaled, other, y, block, goal))

    for one in (y, *_neighbours(y, own)):
        look(one)
    room, size = scaled.values(y, block), measure(here)
    kept, walls = _apart(cuts, room)
    left = _left(scaled, y, block, kept, walls)
    # where they leave a way down the next neighbour is on it, and brings the gradient that they lack
    for _ in range(own):
        if not kept or _size(left) <= OPTIMAL * size or least < here - OPTIMAL * RADIUS * size:
            break
        ahead = y.copy()
        ahead[:own] = np.clip(y[:own] + RADIUS * left / _size(left), 0.0, 1.0)
        look(ahead)
        kept, walls = _apart(cuts, room)
        left = _left(scaled, y, block, kept, walls)
    if not kept:
        return None
    joined = tuple(np.concatenate([getattr(cut, name) for cut in kept]) for name in _Cut._fields[:4])
    # no model says more than what is true at the point: the goal is not convex
    goals = np.minimum(joined[0], here), joined[1]
    return Around(_size(left) / size, best, least, goals, (joined[2], joined[3]), walls)


def _size(left: Array) -> float:
    return float(np.max(np.abs(left), initial=0.0))


def _apart(cuts: list[_Cut], room: Array) -> tuple[list[_Cut], Array]:
    """Those that are not behind a wall, and the directions away from walls.

    Behind a wall a limit is broken that has room at the point, and the linear model there does not see that room.
    """
    behind = np.array([(cut.there < -FEASIBLE) & (cut.limits < 0.5 * room) & (room > CLOSE) for cut in cuts])
    if not len(cuts) or not np.any(behind):
        return cuts, np.zeros((0, cuts[0].goal_slopes.shape[1] if cuts else 0))
    broken, kept = np.any(behind, axis=0), [cut for cut, one in zip(cuts, behind, strict=True) if not np.any(one)]
    # the instant of the event moves fastest where it is about to be lost
    slopes = [np.array([cut.limit_slopes[row] for cut in kept]) for row in np.flatnonzero(broken)]
    walls = [one[int(np.argmax(np.sum(one**2, axis=1)))] for one in slopes if len(one)]
    sizes = [float(np.linalg.norm(one)) for one in walls]
    made = [one / size for one, size in zip(walls, sizes, strict=True) if size > 0.0]
    return kept, np.array(made).reshape(-1, cuts[0].goal_slopes.shape[1])


def is_optimal(found: Around | None, goal: float) -> bool:
    """Whether gradients cancel out, and no neighbour is better."""
    if found is None or found.residual > OPTIMAL:
        return False
    return found.goal >= goal - OPTIMAL * RADIUS * abs(goal)


def left(scaled: Scaled, y: Array) -> float:
    """What is left of the gradients around a point, in shares of the goal; infinite where a neighbour is better."""
    found = around(scaled, y)
    return found.residual if found is not None and is_optimal(found, scaled.goal(y)) else np.inf


def left_behind(scaled: Scaled, y: Array) -> Array:
    """Better unknowns than those of a corner, by steps that know its gradients to all sides."""
    slow, last = 0, scaled.evaluator.runs + MOST_RUNS
    for _ in range(MOST_STEPS):
        if scaled.evaluator.runs >= last:
            break
        found = around(scaled, y)
        here = scaled.goal(y)
        if found is None or is_optimal(found, here) or slow >= MOST_SLOW:
            break
        y = _stepped(scaled, y, found)
        gained = here - scaled.goal(y)
        slow = slow + 1 if gained < SLOW * abs(here) else 0
        if gained <= BETTER * abs(here):
            break
    return y


def _neighbours(y: Array, own: int) -> list[Array]:
    """A step to either side of each unknown, as far as its bounds allow."""
    made = []
    for k in range(own):
        for side in (-RADIUS, RADIUS):
            other = y.copy()
            other[k] = min(max(y[k] + side, 0.0), 1.0)
            if other[k] != y[k]:
                made.append(other)
    return made


def _holds(scaled: Scaled, point: Evaluation, y: Array, block: ConstraintBlock) -> bool:
    """Whether all limits hold."""
    matrix, ends = scaled.linear
    values = scaled.values_at(point, y, block)
    out = np.where(block.equal, np.abs(values), -values)
    return max(float(np.max(one, initial=0.0)) for one in (out, matrix @ y - ends)) <= FEASIBLE


def _cut(scaled: Scaled, other: Array, y: Array, block: ConstraintBlock, goal: ConstraintBlock) -> _Cut:
    own, step = len(scaled.width), (y - other)[: len(scaled.width)]
    if scaled.worst:
        flat = np.append(other[:own], 0.0)
        values, slopes = -scaled.values(flat, goal), -scaled.slopes(flat, goal)[:, :own]
    else:
        values, slopes = np.array([scaled.goal(other)]), scaled.gradient(other)[None, :own]
    limits, by = scaled.values(other, block), scaled.slopes(other, block)[:, :own]
    largest = values >= np.max(values) - CLOSE
    return _Cut(values + slopes @ step, slopes, limits + by @ step, by, limits, largest)


def _left(scaled: Scaled, y: Array, block: ConstraintBlock, cuts: list[_Cut], walls: Array) -> Array:
    """The way down that gradients leave: against their least convex combination, beside active limits and bounds."""
    own = len(scaled.width)
    if not cuts:
        return np.zeros(own)
    matrix, ends = scaled.linear
    goal = np.concatenate([cut.goal_slopes[cut.largest] for cut in cuts])
    near = block.equal | (scaled.values(y, block) <= CLOSE)
    limits = np.concatenate([cut.limit_slopes[near] for cut in cuts])
    equal = np.concatenate([cut.limit_slopes[block.equal] for cut in cuts])
    flat = matrix[ends - matrix @ y <= CLOSE, :own]
    unit = np.eye(own)
    edges = np.vstack([unit[y[:own] <= CLOSE], -unit[y[:own] >= 1.0 - CLOSE]])
    whole = WHOLE * float(np.max(np.abs(goal), initial=1.0))
    others = np.vstack([limits, -equal, -flat, edges, walls])
    normals = np.hstack([np.vstack([-goal.T, np.full(len(goal), whole)]), np.vstack([others.T, np.zeros(len(others))])])
    target = np.append(np.zeros(own), whole)
    factors, _ = need("scipy.optimize", "calibrate", "calibrate").nnls(normals, target, maxiter=100 * normals.shape[1])
    share = float(np.sum(factors[: len(goal)])) or 1.0
    made: Array = (normals @ factors)[:own] / share
    return made


def _stepped(scaled: Scaled, y: Array, found: Around) -> Array:
    """The best of the neighbours and of steps in boxes, by the linear models of all of them."""
    block = ConstraintBlock([row for row in scaled.rows if row.limit >= 0])
    best, least = found.y, found.goal
    for box, off in product(BOXES, OFF if len(found.walls) else OFF[:1]):
        other = _program(scaled, y, found, box, off)
        # without gradients, for much less work
        point = scaled.tried(other)
        other = scaled.lifted(other, point)
        goal = scaled.goal_at(point, other)
        if goal < least and _holds(scaled, point, other, block):
            best, least = other, goal
    return best if scaled.point(best).is_fine else found.y


def _program(scaled: Scaled, y: Array, found: Around, box: float, off: float) -> Array:
    """The step that makes the largest of the linear models least within a box, off the walls by a share of it."""
    own = len(scaled.width)
    matrix, ends = scaled.linear
    (values, slopes), (limits, by) = found.cuts, found.limits
    # what cannot be the largest anywhere in the box does not matter
    change = box * np.sum(np.abs(slopes), axis=1)
    near = values + change >= np.max(values - change)
    close = limits <= 2.0 * box * np.sum(np.abs(by), axis=1) + FEASIBLE
    table = np.vstack([
        np.hstack([slopes[near], -np.ones((np.count_nonzero(near), 1))]),
        np.hstack([-by[close], np.zeros((np.count_nonzero(close), 1))]),
        np.hstack([-found.walls, np.zeros((len(found.walls), 1))]),
        np.hstack([matrix[:, :own], np.zeros((len(ends), 1))]),
    ])  # fmt: skip
    room = np.concatenate(
        [
            -values[near],
            np.maximum(limits[close], 0.0),
            np.full(len(found.walls), -off * box),
            np.maximum(ends - matrix @ y, 0.0),
        ]
    )
    low, high = np.maximum(-y[:own], -box), np.minimum(1.0 - y[:own], box)
    bounds = [*zip(low.tolist(), high.tolist(), strict=True), (None, None)]
    linprog = need("scipy.optimize", "calibrate", "calibrate").linprog
    made = linprog(np.append(np.zeros(own), 1.0), table, room, bounds=bounds, method="highs")
    return y if made.x is None else np.append(np.clip(y[:own] + made.x[:own], 0.0, 1.0), y[own:])
