"""Production scatter: samples of what differs from one gearbox to the next, and limits that hold in all of them.

A few samples at a time are given to the solver, and those that break a limit at what it found join them, until none
does. docs/theory/calibration.md (5)
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.calibration.moves import Moves
from clutchwork.calibration.scaled import Samples, Scaled

if TYPE_CHECKING:
    from clutchwork.calibration.evaluate import Evaluator
    from clutchwork.calibration.moves import Variable
    from clutchwork.calibration.problem import CalibrationProblem

Solve = Callable[[Scaled], Array]
# samples that the solver begins with at most, nominal among them, and whose mean the goal is; and corners beside them
FIRST, FEW = 9, 4
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
    """The samples of production: nominal, those drawn evenly, then the corners."""

    pool: tuple[Array, ...]
    ends: tuple[Array, ...]  # the corners
    worst: bool

    @classmethod
    def of(cls, problem: CalibrationProblem, count: int, seed: int, worst: bool) -> Scatter:
        """So many samples of a problem, and corners."""
        nominal = Moves(problem.scatter, problem.numbers).start(problem.base)
        ends = tuple(corners(problem.scatter))
        return cls((nominal, *drawn(problem.scatter, count - 1, seed), *ends), ends, worst)

    def first(self) -> Samples:
        """Those that the solver begins with: corners are for limits alone, they are not production."""
        even = self.pool[: len(self.pool) - len(self.ends)][:FIRST]
        few = self.ends if len(self.ends) <= FEW else ()
        if self.worst and self.ends:
            return Samples((even[0], *self.ends)[:FIRST], 1, True)
        return Samples((*even, *few), len(even), self.worst)


def corners(unknowns: Sequence[Variable]) -> list[Array]:
    """All ends of what scatters together, where that are not many: what gets worse all the way is worst there."""
    if len(unknowns) > MOST_CORNERS:
        return []
    return [np.array(one) for one in product(*((one.low, one.high) for one in unknowns))]


def drawn(unknowns: Sequence[Variable], count: int, seed: int) -> tuple[Array, ...]:
    """Samples between the bounds of what scatters, spread evenly by a Sobol sequence, whatever order they come in."""
    if count < 1:
        return ()
    low, high = (np.array([getattr(one, side) for one in unknowns]) for side in ("low", "high"))
    places = np.argsort(np.argsort([one.name for one in unknowns], kind="stable"))
    return tuple(low + share[places] * (high - low) for share in sobol(len(unknowns), count, seed))


def sobol(dimensions: int, count: int, seed: int) -> Array:
    """Points in the unit cube, as many as asked for, of a scrambled Sobol sequence."""
    qmc = need("scipy.stats.qmc", "calibrate", "calibrate")
    if count < 1:
        return np.zeros((0, dimensions))
    # whole powers of two keep it balanced
    power = max(0, int(np.ceil(np.log2(max(count, 1)))))
    made: Array = qmc.Sobol(dimensions, scramble=True, seed=seed).random_base2(power)
    return made[:count]


def in_all(
    evaluator: Evaluator, scatter: Scatter, start: Array, solve: Solve, scales: tuple[float, ...] | None = None
) -> Array:  # fmt: skip
    """Unknowns at which limits hold in all samples, as far as that can be."""
    scaled = Scaled(evaluator, start, scatter.first(), scales)
    x = scaled.to_x(solve(scaled))
    for _ in range(MOST_ROUNDS - 1):
        joining = breaking(evaluator, scaled, x, scatter.pool)
        if not joining:
            break
        more = Samples((*scaled.samples, *joining), scaled.averaged, scatter.worst)
        scaled = Scaled(evaluator, x, more, scaled.scales, scaled.goal_scale)
        scaled.begin(scaled.start, LATER_REACH)
        x = scaled.to_x(solve(scaled))
    return x


def breaking(evaluator: Evaluator, scaled: Scaled, x: Array, pool: Sequence[Array]) -> list[Array]:
    """The samples that break limits most: the worst one of each limit, then the next."""
    values = evaluator.values(x, pool)
    # what the model refuses cannot join
    refused = np.all(np.isnan(values), axis=1)
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
            if over[number, limit] > TOLERANCE and not refused[number] and pool[number].tobytes() not in chosen:
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
