"""Production scatter: samples of what differs from one gearbox to the next, and limits that hold in all of them.

A few samples at a time are given to the solver, and those that break a limit at what it found join them, until none
does. docs/theory/calibration.md (5)
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.extras import need
from clutchwork.calibration.moves import Moves
from clutchwork.calibration.scaled import Samples, Scaled

if TYPE_CHECKING:
    from clutchwork.calibration.evaluate import Evaluator
    from clutchwork.calibration.moves import Unknown
    from clutchwork.calibration.problem import Problem

Array = NDArray[np.float64]
Solve = Callable[[Scaled], Array]
# samples that the solver begins with at most, nominal and corners among them, and whose mean the goal is
FIRST = 8
# how far later rounds go from what the one before found, in shares of the bounds
LATER_REACH = 0.05
# dimensions of which all corners are taken
MOST_CORNERS = 4
# samples that join in one round, and rounds
MOST_JOIN, MOST_ROUNDS = 4, 8
# of a limit, in shares of its scale; and of the goal of a sample above the worst of those that are looked at
TOLERANCE, WORSE = 1e-6, 1e-2


@dataclass(frozen=True)
class Scatter:
    """The samples of production, nominal first."""

    pool: tuple[Array, ...]
    worst: bool

    @classmethod
    def of(cls, problem: Problem, count: int, seed: int, worst: bool) -> Scatter:
        """So many samples of a problem."""
        nominal = Moves(problem.scatter, problem.numbers).start(problem.base)
        ends = corners(problem.scatter)[: max(count - 1, 0)]
        return cls((nominal, *ends, *drawn(problem.scatter, count - 1 - len(ends), seed)), worst)

    def first(self) -> Samples:
        """Those that the solver begins with."""
        corners = 2 ** len(self.pool[0])
        count = min(FIRST, 1 + corners, len(self.pool))
        return Samples(self.pool[:count], count, self.worst)


def corners(unknowns: Sequence[Unknown]) -> list[Array]:
    """All ends of what scatters together, where that are not many: what gets worse all the way is worst there."""
    if len(unknowns) > MOST_CORNERS:
        return []
    return [np.array(one) for one in product(*((one.low, one.high) for one in unknowns))]


def drawn(unknowns: Sequence[Unknown], count: int, seed: int) -> tuple[Array, ...]:
    """Samples between the bounds of what scatters, spread evenly by a Sobol sequence."""
    if count < 1:
        return ()
    low, high = (np.array([getattr(one, side) for one in unknowns]) for side in ("low", "high"))
    return tuple(low + share * (high - low) for share in sobol(len(unknowns), count, seed))


def sobol(dimensions: int, count: int, seed: int) -> Array:
    """Points in the unit cube, as many as asked for, of a scrambled Sobol sequence."""
    qmc = need("scipy.stats.qmc", "calibrate", "calibrate")
    if count < 1:
        return np.zeros((0, dimensions))
    # whole powers of two keep it balanced
    power = max(0, int(np.ceil(np.log2(max(count, 1)))))
    made: Array = qmc.Sobol(dimensions, scramble=True, seed=seed).random_base2(power)
    return made[:count]


def in_all(evaluator: Evaluator, scatter: Scatter, start: Array, solve: Solve) -> tuple[Array, Samples]:
    """Unknowns at which limits hold in all samples, as far as that can be, and the samples that decided it."""
    samples, x, scales = scatter.first(), start, None
    for _ in range(MOST_ROUNDS):
        scaled = Scaled(evaluator, x, samples, scales)
        if scales is not None:
            scaled.begin(scaled.start, LATER_REACH)
        scales = scaled.scales
        x = scaled.to_x(solve(scaled))
        if len(samples.chosen) == len(scatter.pool):
            break
        joining = _broken(evaluator, scaled, x, scatter.pool)
        if not joining:
            break
        samples = samples._replace(chosen=(*samples.chosen, *joining))
    return x, samples


def _broken(evaluator: Evaluator, scaled: Scaled, x: Array, pool: Sequence[Array]) -> list[Array]:
    """The samples that break limits most: the worst one of each limit, then the next."""
    values = evaluator.values(x, pool)
    over = violations(evaluator, scaled, values)
    if scaled.worst:
        goal = evaluator.parts[0]
        known = np.max(evaluator.at(x, scaled.samples).values[:, goal])
        # of the worst of all samples none is left out
        more = (np.max(values[:, goal], axis=1) - known) / scaled.goal_scale
        over = np.column_stack([over, np.where(np.isfinite(more), np.maximum(more - WORSE, 0.0), np.inf)])
    chosen = {one.tobytes() for one in scaled.samples}
    order = np.argsort(-over, axis=0, kind="stable")
    found = dict[int, None]()
    for rank in range(len(pool)):
        for limit, number in enumerate(order[rank].tolist()):
            if over[number, limit] > TOLERANCE and pool[number].tobytes() not in chosen:
                found.setdefault(number)
        if len(found) >= MOST_JOIN:
            break
    return [pool[number] for number in list(found)[:MOST_JOIN]]


def violations(evaluator: Evaluator, scaled: Scaled, values: Array) -> Array:
    """By how much each sample breaks each limit, in shares of its scale; infinite where a value is missing."""
    limits, parts = evaluator.problem.limits, evaluator.parts[1:]
    made = np.zeros((len(values), max(len(limits), 1)))
    scales = scaled.scales
    for number, (limit, part) in enumerate(zip(limits, parts, strict=True)):
        own = values[:, part]
        over = np.max(np.maximum(own - limit.upper, limit.lower - own), axis=1) / scales[number]
        made[:, number] = np.where(np.isfinite(over), np.maximum(over, 0.0), np.inf)
    return made
