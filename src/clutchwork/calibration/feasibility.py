"""Limits first: where they are far from being held, the worst of them is made least before the goal counts."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.calibration.outcome import FEASIBLE
from clutchwork.calibration.rows import ConstraintBlock, Row
from clutchwork.calibration.scaled import Samples, Scaled

if TYPE_CHECKING:
    from clutchwork.calibration.evaluate import Evaluation

# limits count as held with so much to spare, in shares of their scale
SPARE = 1e-3
# or with so much of the band between two bounds
BAND = 0.4


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
