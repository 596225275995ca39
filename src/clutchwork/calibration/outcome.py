"""What one start of a search led to."""

from __future__ import annotations

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array

# limits may be broken by so much, in shares of their scale
FEASIBLE = 1e-6
# what is left of a gradient, in shares of the goal over the ranges of the unknowns
OPTIMAL = 1e-3


@dataclass(frozen=True)
class Outcome:
    """Where one start ended."""

    number: int
    start: Array
    x: Array
    goal: float
    violation: float  # of the worst limit, in shares of its scale
    ended: bool  # not interrupted
    runs: int
    scales: tuple[float, ...] = ()  # of the limits
    samples: tuple[Array, ...] = ()  # of production that decided it
    fault: str = ""  # why nothing was found
    whole: bool = True  # all samples of production were run at x, not only those of the solver
    iterations: int = 0  # that the solver was given
    residual: float = np.inf  # what is left of the gradient, in shares of the goal

    @property
    def holds(self) -> bool:
        """Whether all limits hold in the samples that were run."""
        return self.violation <= FEASIBLE

    @property
    def is_feasible(self) -> bool:
        """Whether all limits hold in all samples."""
        return self.whole and self.holds

    @property
    def is_solved(self) -> bool:
        """Whether no more iterations would help."""
        return bool(self.fault) or (self.is_feasible and self.residual <= OPTIMAL)

    @property
    def rank(self) -> tuple[bool, float, float]:
        """Less is better: those of all samples first, feasible ones by their goal, others by how far they are out."""
        return not self.whole, 0.0 if self.holds else self.violation, self.goal
