"""The integral of the square of the jerk, and how it changes: docs/theory/gradients.md (15)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.functional import Functional
from clutchwork.gradients.instants import BEND, add_shift
from clutchwork.gradients.primal import SMOOTH, Primal
from clutchwork.gradients.signals import add_signal
from clutchwork.gradients.steps import Steps

Array = NDArray[np.float64]


def value(steps: Steps, acceleration: Array) -> float:
    """The integral over all steps, from the acceleration in the rows of each."""
    return float(np.einsum("ni,nij,nj->", acceleration, steps.squared_slope, acceleration))


def add_jerk(primal: Primal, signal: str, acceleration: Array, into: Functional) -> None:
    """How it changes: inside of the steps, and by the instants between them, which move."""
    steps = primal.steps
    inside = 2.0 * np.einsum("nij,nj->ni", steps.squared_slope, acceleration)
    add_signal(primal, signal, steps.rows.ravel(), inside.ravel(), into)
    for step in np.flatnonzero(primal.between[0][1:] != SMOOTH) + 1:
        before = float(steps.right_slope[step - 1] @ acceleration[step - 1])
        behind = float(steps.left_slope[step] @ acceleration[step])
        add_shift(primal, int(step), before**2 - behind**2, into)


def kinks(primal: Primal, acceleration: Array) -> tuple[float, ...]:
    """Instants at which knots meet that it depends on [s]: one of them first is not as the other one first."""
    steps = primal.steps
    if not primal.meets:
        return ()
    before = np.r_[0.0, np.einsum("ni,ni->n", steps.right_slope, acceleration)]
    behind = np.r_[np.einsum("ni,ni->n", steps.left_slope, acceleration), 0.0]
    allowed = BEND * float(max(np.abs(before).max(), np.abs(behind).max()))
    return tuple(time for time, place in primal.meets if abs(before[place] - behind[place]) > allowed)
