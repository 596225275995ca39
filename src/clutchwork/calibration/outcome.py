"""What one start of a search led to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass

Array = NDArray[np.float64]
# limits may be broken by so much, in shares of their scale
FEASIBLE = 1e-6


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

    @property
    def is_feasible(self) -> bool:
        """Whether all limits hold."""
        return self.violation <= FEASIBLE

    @property
    def rank(self) -> tuple[float, float]:
        """Less is better: feasible ones by their goal, others by how far they are out."""
        return (0.0, self.goal) if self.is_feasible else (self.violation, self.goal)
