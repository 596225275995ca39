"""A signal on both sides of an instant without an event, where it may bend or jump: docs/theory/gradients.md (19)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.primal import Primal
from clutchwork.gradients.signals import signal_at
from clutchwork.gradients.steps import Steps

Array = NDArray[np.float64]

# slopes that differ by more are those of a bend, of the larger one
BENT = 1e-3
# limits from both sides that differ by more are those of a jump, of the larger one
JUMP = 1e-6


class Sides(NamedTuple):
    """A signal on both sides of an instant without an event: its values, its slopes, and where rows are [s]."""

    before: float
    behind: float
    rise: float
    fall: float
    gap: tuple[float, float]

    @classmethod
    def of(cls, steps: Steps, end: int, before: Array, behind: Array) -> Sides:
        """Those at the begin of a step, from the values in the rows of the step before and of its own."""
        first = float((steps.share[end - 1, -1] - 1.0) * steps.length[end - 1])
        last = float(steps.share[end, 0] * steps.length[end])
        values = float(steps.right[end - 1] @ before), float(steps.left[end] @ behind)
        slopes = float(steps.right_slope[end - 1] @ before), float(steps.left_slope[end] @ behind)
        return cls(*values, *slopes, (first, last))

    @property
    def differ(self) -> bool:
        """Whether the values are those of a jump."""
        return abs(self.before - self.behind) > JUMP * max(abs(self.before), abs(self.behind))

    @property
    def meeting(self) -> float | None:
        """How far behind the instant both sides meet in a bend, where no rows are between [s]; None without one."""
        if abs(self.rise - self.fall) <= BENT * max(abs(self.rise), abs(self.fall)):
            return None
        away = (self.behind - self.before) / (self.rise - self.fall)
        return away if self.gap[0] <= away <= self.gap[1] else None if self.differ else 0.0


def jumps(primal: Primal, signal: str, end: int) -> bool:
    """Whether a signal jumps between two steps."""
    sides = Sides.of(primal.steps, end, *_beside(primal, signal, end))
    return sides.differ and sides.meeting is None


def _beside(primal: Primal, signal: str, end: int) -> tuple[Array, Array]:
    """The signal in the rows of the steps before and behind an instant."""
    rows = primal.steps.rows
    return signal_at(primal, signal, rows[end - 1]), signal_at(primal, signal, rows[end])


def of_bend(primal: Primal, signal: str, end: int, sign: float) -> list[tuple[int, Array]]:
    """Weights of the rows of both steps beside an instant without an event; none where the signal does not bend there.

    Both sides stay equal, which says how the instant moves.
    """
    steps, sides = primal.steps, Sides.of(primal.steps, end, *_beside(primal, signal, end))
    away = sides.meeting
    if away is None:
        return []
    shares = sign * sides.fall / (sides.fall - sides.rise), sign * sides.rise / (sides.rise - sides.fall)
    before = shares[0] * (steps.right[end - 1] + away * steps.right_slope[end - 1])
    behind = shares[1] * (steps.left[end] + away * steps.left_slope[end])
    return [(end - 1, before), (end, behind)]
