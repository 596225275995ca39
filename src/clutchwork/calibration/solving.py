"""From one start to its end: the solver where all is smooth, limits first, boxes where there are corners."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.calibration.ending import Ending
from clutchwork.calibration.optimal import certificate
from clutchwork.calibration.outcome import FEASIBLE
from clutchwork.calibration.rows import ConstraintBlock, Row, measure, size_of
from clutchwork.calibration.scaled import FIRST_REACH, Samples, Scaled
from clutchwork.calibration.scatter import Scatter, sobol
from clutchwork.calibration.slsqp import slsqp
from clutchwork.calibration.trust_region_lp import walked

if TYPE_CHECKING:
    from clutchwork.calibration.evaluate import Evaluation, Evaluator

# times that a search begins anew, what may be left of the gradient, and what counts as better, in shares of the goal
MOST_AGAIN, ENOUGH, LITTLE = 3, 1e-6, 1e-3
# the same where steps in boxes end, in a corner
CORNER = 1e-4
# runs for each sample that may be spent on limits alone, twice
RESTORING = 70
# limits that are broken by less, in shares of their scale, are seen to on the way
NEAR = 0.1
# box of a solver that begins where steps became small, in shares of the bounds
SHORTEST = 1e-2
# points that are run for each start, of which the best is taken
PILOTS = 8
# limits count as held with so much to spare, in shares of their scale
SPARE = 1e-3
# or with so much of the band between two bounds
BAND = 0.4


@dataclass(frozen=True)
class SearchMethod:
    """How to search."""

    tolerance: float
    iterations: int
    starts: int
    threads: int
    seed: int
    scatter: Scatter | None

    def samples(self, chosen: tuple[Array, ...]) -> Samples:
        """These samples, judged as the goal asks."""
        if self.scatter is None:
            return Samples(chosen)
        return Samples(chosen, self.scatter.first().averaged, self.scatter.worst)


@dataclass(frozen=True)
class Solving:
    """The way from a start to its end."""

    way: SearchMethod

    def solved(self, scaled: Scaled) -> Array:
        """Where the search ends: the solver where all is smooth, limits first, then boxes where there are corners."""
        if not scaled.worst or scaled.reach == FIRST_REACH:
            y = self._smooth(scaled)
            if self._left(scaled, y) <= ENOUGH:
                return y
            scaled.begin(y, scaled.reach)
        if self._broken(scaled, scaled.start) <= NEAR and self._broken(scaled, y := self._cornered(scaled)) <= FEASIBLE:
            return y
        return self._cornered(scaled) if self._held(scaled) else scaled.start

    def _cornered(self, scaled: Scaled) -> Array:
        """Where boxes and the solver in turn end."""
        y = scaled.start
        for _ in range(MOST_AGAIN):
            y, reach = walked(scaled, y, scaled.reach)
            before, left = scaled.goal(y), self._left(scaled, y)
            # the worst of several samples is in a corner, where a solver for smooth goals finds no more
            if left <= CORNER or (scaled.worst and len(scaled.samples) > 1):
                break
            scaled.begin(y, max(reach, SHORTEST))
            y = self._smooth(scaled)
            if self._left(scaled, y) <= ENOUGH or before - scaled.goal(y) <= LITTLE * abs(before):
                break
        return y

    def _smooth(self, scaled: Scaled) -> Array:
        """Where the solver ends."""
        return slsqp(scaled, Ending(scaled, self.way.tolerance), self.way.iterations)

    def _left(self, scaled: Scaled, y: Array) -> float:
        """What is left of the gradient, in shares of the goal; infinite where limits are broken."""
        proof = certificate(scaled, y)
        return proof.residual / measure(scaled.goal(y)) if proof.violation <= FEASIBLE else np.inf

    def _broken(self, scaled: Scaled, y: Array) -> float:
        """By how much the worst limit is broken."""
        return certificate(scaled, y).violation

    def _held(self, scaled: Scaled) -> bool:
        """Whether all limits hold somewhere; the search begins there, or where they are broken least."""
        best, least, held = scaled.start, np.inf, False
        for x in self._restored_from(scaled):
            limits = Restoring(scaled, x)
            y, _ = walked(limits, limits.start, FIRST_REACH, RESTORING)
            if y[-1] < least:
                best, least, held = y[: scaled.count], y[-1], limits.is_enough(y)
            if held:
                break
        scaled.begin(best, FIRST_REACH)
        return held

    def _restored_from(self, scaled: Scaled) -> Iterator[Array]:
        """The start, and where that leads nowhere the best of points that are spread over the bounds."""
        problem = scaled.problem
        yield scaled.to_x(scaled.start)
        shares = sobol(len(problem.unknowns), PILOTS, self.way.seed)
        points = [scaled.flat.nearest(problem.low + share * scaled.flat.width) for share in shares]
        yield from best_of(scaled.evaluator, points, 1)


def best_of(evaluator: Evaluator, points: Sequence[Array], count: int) -> list[Array]:
    """The points that break limits least, then those with the least goal; those without a value come last."""
    values = np.concatenate([evaluator.values(point, [evaluator.nominal]) for point in points])
    over = np.zeros(len(points))
    for limit, part in zip(evaluator.problem.limits, evaluator.parts[1:], strict=True):
        own, size = values[:, part], size_of(limit) or 1.0
        over += np.max(np.maximum(own - limit.upper, limit.lower - own), axis=1, initial=0.0) / size
    goal = np.max(values[:, evaluator.parts[0]], axis=1)
    order = np.lexsort((goal, np.where(np.isfinite(over + goal), over, np.inf)))
    return [points[place] for place in order[:count]]


class Restoring(Scaled):
    """The same unknowns and limits; the goal is by how much the worst limit is broken, one unknown more."""

    def __init__(self, other: Scaled, x: Array) -> None:
        samples = Samples(tuple(other.samples), other.averaged, True)
        super().__init__(other.evaluator, x, samples, other.scales)
        self.goal_scale = 1.0
        self.begin(self.start, self.reach)

    def lifted(self, y: Array, found: Evaluation) -> Array:
        """The same unknowns, and by how much the worst limit is broken."""
        if not found.is_fine:
            return y.copy()
        return np.append(y[:-1], -np.min(self._block.values(found, y)) if self.rows else -1.0)

    def is_enough(self, y: Array) -> bool:
        """Whether all limits hold, those that need no run too."""
        matrix, ends = self.linear
        return bool(y[-1] <= self._enough and np.all(matrix @ y <= ends + FEASIBLE))

    @cached_property
    def _enough(self) -> float:
        """The margin in the middle of a narrow band is less than half of it; an equation has none."""
        made = [
            FEASIBLE if one.is_equal else max(-SPARE, -BAND * (one.upper - one.lower) / scale)
            for one, scale in zip(self.problem.limits, self.scales, strict=True)
        ]
        return max(made, default=-SPARE)

    @cached_property
    def rows(self) -> list[Row]:
        """All limits that need a run; an equation is two inequalities."""
        limits = (one for one in super().rows if one.limit >= 0)
        return [one._replace(sign=sign) for one in limits for sign in ((1.0, -1.0) if one.sign == 0.0 else (one.sign,))]

    @cached_property
    def _block(self) -> ConstraintBlock:
        return ConstraintBlock(self.rows)

    def values_at(self, found: Evaluation, y: Array, block: ConstraintBlock) -> Array:
        """What must not be negative: room up to the bounds, and what may be broken."""
        made: Array = super().values_at(found, y, block) + y[-1]
        return made

    def slopes(self, y: Array, block: ConstraintBlock) -> Array:
        """Their derivatives."""
        made = super().slopes(y, block)
        made[:, -1] = 1.0
        return made
