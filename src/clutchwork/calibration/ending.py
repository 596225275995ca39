"""When a solver may end: at a point that is optimal, or where nothing gets better any more.

Runs have errors of their own, so that differences of the goal say less than its gradient.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.calibration.optimal import certificate
from clutchwork.calibration.rows import measure

if TYPE_CHECKING:
    from clutchwork.calibration.scaled import Scaled

# what may be left of the gradient, and of limits, in shares of their scales
RESIDUAL, VIOLATION = 3e-7, 1e-8
# what a limit that is broken by its scale costs, in goals; and by how much of itself a point may be worse than the best
PRICE, LOST = 10.0, 1.0
# steps that may bring less than a share of the goal, or half of what is left of the gradient
MOST_STALLED, LITTLE = 6, 1e-5
# runs for each sample, differences in place of gradients counted as one each
MOST_RUNS = 150


class SearchEnded(Exception):  # noqa: N818, it is caught where it is raised
    """The search is at its end, or lost."""


class Ending:
    """Looks at each step of a solver; `SearchEnded` where it was the last one, and `best` is the best of them."""

    def __init__(self, scaled: Scaled, tolerance: float) -> None:
        self.scaled, self.tolerance = scaled, tolerance
        self.best, self.residual, self.stalled = scaled.start, np.inf, 0
        self.merit = scaled.goal(scaled.start) + PRICE * certificate(scaled, scaled.start).violation
        self.last = scaled.evaluator.runs + MOST_RUNS * max(len(scaled.samples), 1)

    def look(self, y: Array) -> None:
        """At the scaled unknowns after a step."""
        if not self.scaled.point(y).is_fine:
            return
        found, goal = certificate(self.scaled, y), self.scaled.goal(y)
        # of the goal that there is, not of that at the start
        residual = found.residual / measure(goal)
        if self.scaled.is_enough(y) or (residual <= RESIDUAL and found.violation <= VIOLATION):
            self.best, self.merit = y.copy(), goal
            raise SearchEnded
        merit = goal + PRICE * found.violation
        close = found.violation <= VIOLATION and residual < 0.5 * self.residual
        helps = merit < self.merit - LITTLE * abs(merit) or close
        self.stalled = 0 if helps else self.stalled + 1
        lost = merit > self.merit + LOST * abs(self.merit)
        if merit < self.merit:
            self.best, self.merit = y.copy(), merit
        if found.violation <= VIOLATION:
            self.residual = min(residual, self.residual)
        if lost or self.stalled >= MOST_STALLED or self.scaled.evaluator.runs >= self.last:
            raise SearchEnded
