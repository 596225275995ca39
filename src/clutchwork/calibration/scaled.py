"""The same problem in scaled unknowns and outputs, as solvers take it.

Unknowns go from 0 to 1 between their bounds. Where the worst of several values is to be made least, one unknown more is
a bound of all of them. docs/theory/calibration.md (1)
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.arrays import Array
from clutchwork.calibration.linear import LinearLimits, is_linear_table, without_run
from clutchwork.calibration.rows import ConstraintBlock, Row, measure, rows_of, size_of
from clutchwork.calibration.terms import SquaredSlope

if TYPE_CHECKING:
    from clutchwork.calibration.evaluate import Evaluation, Evaluator

# how far the first search goes, in shares of the bounds
FIRST_REACH = 0.2
# a value that no solver takes for an improvement, in scaled numbers
REFUSED = 1e3


class Samples(NamedTuple):
    """Samples of production that are looked at: limits hold in all of them, the goal is that of the first ones."""

    chosen: tuple[Array, ...] = ()  # nominal where there is none
    averaged: int = 1
    worst: bool = False  # the goal is the worst of them, not their mean


class Scaled:
    """Goal, limits and linear limits over scaled unknowns."""

    def __init__(
        self, evaluator: Evaluator, start: Array, samples: Samples, scales: tuple[float, ...] | None = None,
        first_goal: float = 0.0,
    ) -> None:  # fmt: skip
        self.evaluator, self.problem = evaluator, evaluator.problem
        self.samples, self.averaged = list(samples.chosen), samples.averaged
        self.flat, self._scales = LinearLimits(self.problem), scales
        self.width = self.flat.width
        self.first = self.last = evaluator.at(start, self.samples)
        goal = evaluator.parts[0]
        self.worst = samples.worst or goal.stop - goal.start > 1
        values = self.first.values[:, goal]
        self.goal_scale = measure(float(np.max(np.abs(values))), first_goal)
        own = (start - self.problem.low) / self.width
        self.reach = FIRST_REACH
        self.start = np.append(own, np.max(values) / self.goal_scale) if self.worst else own

    @property
    def count(self) -> int:
        """Unknowns of the solver."""
        return len(self.start)

    def to_x(self, y: Array) -> Array:
        """The unknowns, within their bounds whatever round-off a solver has."""
        made: Array = self.problem.low + np.clip(y[: len(self.width)], 0.0, 1.0) * self.width
        return np.minimum(made, self.problem.high)

    def point(self, y: Array) -> Evaluation:
        """What is known there; remembered where it is fine, for the values of one that is not."""
        found = self.evaluator.at(self.to_x(y), self.samples)
        if found.is_fine:
            self.last = found
        return found

    def tried(self, y: Array) -> Evaluation:
        """Values without a gradient, for much less work."""
        return self.evaluator.tried(self.to_x(y), self.samples)

    # ------------------------------------------------------------------------------------------------------------ goal

    def goal(self, y: Array) -> float:
        """The goal; large where the run has no value or no gradient, so that a solver goes back."""
        return self.goal_at(self.point(y), y)

    def goal_at(self, found: Evaluation, y: Array) -> float:
        """The goal at a point that is known."""
        if not found.is_fine:
            return REFUSED + abs(float(y[-1]))
        return float(y[-1]) if self.worst else self.judged(found.values) / self.goal_scale

    def judged(self, values: Array) -> float:
        """The goal of the values of many samples: the worst of them, or the mean of the first ones."""
        goal = values[:, self.evaluator.parts[0]]
        return float(np.max(goal)) if self.worst else float(np.mean(goal[: self.averaged]))

    def gradient(self, y: Array) -> Array:
        """Its derivatives."""
        if self.worst:
            return np.append(np.zeros(len(self.width)), 1.0)
        self.point(y)
        slopes: Array = np.mean(self.last.slopes[: self.averaged, self.evaluator.parts[0].start], axis=0)
        return slopes * self.width / self.goal_scale

    @property
    def steepest(self) -> float:
        """Size of the gradient of the goal at the start, of its worst value where it has several."""
        if not self.worst:
            return float(np.linalg.norm(self.gradient(self.start)))
        part, point = self.evaluator.parts[0], self.point(self.start)
        sample, row = np.unravel_index(np.argmax(point.values[:, part]), point.values[:, part].shape)
        return float(np.linalg.norm(point.slopes[sample, part][row] * self.width)) / self.goal_scale

    @property
    def box(self) -> tuple[Array, Array]:
        """How far a solver without a region of trust may go: to the bounds, and no further than `reach`."""
        own = self.start[: len(self.width)]
        if self.curvature is not None:
            return -own, 1.0 - own
        return np.maximum(-own, -self.reach), np.minimum(1.0 - own, self.reach)

    def is_enough(self, y: Array) -> bool:  # noqa: ARG002, others do
        """Whether a search may end there although it is not optimal."""
        return False

    def begin(self, y: Array, reach: float) -> None:
        """Begin somewhere, and go no further than so much of the bounds, where no curvature is known."""
        self.start, self.reach = self.lifted(y, self.point(y)), reach

    def lifted(self, y: Array, found: Evaluation) -> Array:
        """The unknowns, with the last one raised to the largest of several values of the goal."""
        made = y.copy()
        if self.worst and found.is_fine:
            made[-1] = float(np.max(found.values[:, self.evaluator.parts[0]])) / self.goal_scale
        return made

    @cached_property
    def curvature(self) -> Array | None:
        """What is known of the second derivatives of the goal before any run; None where nothing is."""
        found = [(one, weight) for one, weight in self.problem.goal.terms if isinstance(one, SquaredSlope)]
        if self.worst or not found or not all(is_linear_table(self.problem, one.stem) for one, _ in found):
            return None
        given = without_run(self.problem)
        total = np.sum([weight * one.curvature(given) for one, weight in found], axis=0)
        by_y = self.evaluator.moves.slopes(self.problem.base, self.problem.start) * self.width
        made: Array = by_y.T @ total @ by_y / self.goal_scale
        return made

    # ---------------------------------------------------------------------------------------------------------- limits

    @cached_property
    def scales(self) -> tuple[float, ...]:
        """What each limit is compared with: its bounds, or its size at the first start."""
        if self._scales is not None:
            return self._scales
        made = list[float]()
        for number, limit in enumerate(self.problem.limits):
            there = self.first.values[:, self.evaluator.parts[number + 1]]
            own = 0.0 if number in self.flat.numbers else float(np.max(np.abs(there)))
            made.append(max(size_of(limit), own) or 1.0)
        return tuple(made)

    @cached_property
    def linear(self) -> tuple[Array, Array]:
        """Matrix and right-hand side of the limits that are linear: A y <= b."""
        more = np.zeros((len(self.flat.rows), self.count - len(self.width)))
        return np.hstack([self.flat.matrix, more]), self.flat.ends

    @cached_property
    def rows(self) -> list[Row]:
        """The limits that need a run, in all samples, and the worst of the goal."""
        limits, parts = self.problem.limits, self.evaluator.parts
        own = [
            row
            for number, limit in enumerate(limits)
            if number not in self.flat.numbers
            for row in rows_of(limit, number, parts[number + 1], self.scales[number])
        ]
        goal = range(parts[0].start, parts[0].stop) if self.worst else range(0)
        both = [*own, *(Row(0, row, 0.0, 1.0, self.goal_scale, -1) for row in goal)]
        return [one._replace(sample=sample) for sample in range(max(len(self.samples), 1)) for one in both]

    def values(self, y: Array, block: ConstraintBlock) -> Array:
        """What must not be negative, or must be zero in equations."""
        self.point(y)
        return self.values_at(self.last, y, block)

    def values_at(self, found: Evaluation, y: Array, block: ConstraintBlock) -> Array:
        """The same at a point that is known."""
        return block.values(found, y)

    def within(self, block: ConstraintBlock, values: Array, slopes: Array, reach: float) -> NDArray[np.bool_]:
        """Rows that matter within a box, as far as their gradients say."""
        own = len(self.width)
        change = reach * np.sum(np.abs(slopes[:, :own]), axis=1)
        # the bound of several values moves too, and so do limits that are broken
        more = np.max(change, initial=0.0) if self.count > own else -np.min(values, initial=0.0)
        made: NDArray[np.bool_] = block.equal | (values <= change + more)
        return made

    def slopes(self, y: Array, block: ConstraintBlock) -> Array:
        """Their derivatives."""
        self.point(y)
        return block.slopes(self.last, self.width, self.count)
