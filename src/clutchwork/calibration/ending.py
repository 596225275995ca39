"""When a solver may end: at a point that is optimal, or where nothing gets better any more.

Runs have errors of their own, so that differences of the goal say less than its gradient.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.calibration.optimal import certificate

if TYPE_CHECKING:
    from clutchwork.calibration.scaled import Scaled

Array = NDArray[np.float64]
# what may be left of the gradient, and of limits, in shares of their scales
RESIDUAL, VIOLATION = 3e-7, 1e-8
# steps that may bring nothing
MOST_STALLED = 4


class Ended(Exception):  # noqa: N818, it is caught where it is raised
    """The search is at its end, at some scaled unknowns."""

    def __init__(self, y: Array) -> None:
        super().__init__()
        self.y = y


class Ending:
    """Looks at each step of a solver; `Ended` where it was the last one."""

    def __init__(self, scaled: Scaled, tolerance: float) -> None:
        self.scaled, self.tolerance = scaled, tolerance
        self.goal, self.residual, self.stalled = np.inf, np.inf, 0

    def look(self, y: Array) -> None:
        """At the scaled unknowns after a step."""
        if not self.scaled.point(y).is_fine:
            return
        found = certificate(self.scaled, y)
        if found.residual <= RESIDUAL and found.violation <= VIOLATION:
            raise Ended(y.copy())
        goal = self.scaled.goal(y)
        better = goal < self.goal - self.tolerance or found.residual < 0.5 * self.residual
        self.stalled = 0 if better or found.violation > VIOLATION else self.stalled + 1
        self.goal, self.residual = min(goal, self.goal), min(found.residual, self.residual)
        if self.stalled >= MOST_STALLED:
            raise Ended(y.copy())
