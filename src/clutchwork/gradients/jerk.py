"""How the integral of the square of the jerk changes: docs/theory/gradients.md (15) and (16)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.functional import Functional
from clutchwork.gradients.instants import BEND, JUMP, add_shift
from clutchwork.gradients.primal import EVENT, KNOT, Primal
from clutchwork.gradients.signals import add_signal
from clutchwork.gradients.steps import Steps

Array = NDArray[np.float64]


def add_jerk(primal: Primal, signal: str, acceleration: Array, into: Functional) -> None:
    """How it changes: inside of the steps, and by the instants between them, which move.

    Parameters: acceleration, a line for the rows of each step.
    """
    steps = primal.steps
    inside = 2.0 * np.einsum("nij,nj->ni", steps.squared_slope, _varying(acceleration))
    before, behind = (side[1:-1] for side in _limits(steps, acceleration))
    known = np.isin(primal.between[0][1:], (EVENT, KNOT))
    smooth = ~known & (~steps.jumps[1:] | (_rise(steps, acceleration) <= JUMP))
    # what moves an instant at which it bends makes both limits differ at a fixed time: it need not be known
    share = np.where(smooth, before + behind, 0.0)[:, None]
    rows = np.concatenate([steps.rows, steps.rows[1:], steps.rows[:-1]])
    weights = np.concatenate([inside, share * steps.left[1:], -share * steps.right[:-1]])
    add_signal(primal, signal, rows.ravel(), weights.ravel(), into)
    for step in np.flatnonzero(~smooth):
        add_shift(primal, int(step) + 1, float(before[step] ** 2 - behind[step] ** 2), into)


def kinks(primal: Primal, acceleration: Array) -> tuple[float, ...]:
    """Instants at which knots meet that it depends on [s]: one of them first is not as the other one first."""
    if not primal.meets:
        return ()
    before, behind = _limits(primal.steps, acceleration)
    allowed = BEND * float(max(np.abs(before).max(), np.abs(behind).max()))
    return tuple(time for time, place in primal.meets if abs(before[place] - behind[place]) > allowed)


def _limits(steps: Steps, acceleration: Array) -> tuple[Array, Array]:
    """The jerk on both sides of each instant at which a step begins or ends, zero outside of the run."""
    varying = _varying(acceleration)
    before = np.r_[0.0, np.einsum("ni,ni->n", steps.right_slope, varying)]
    behind = np.r_[np.einsum("ni,ni->n", steps.left_slope, varying), 0.0]
    return before, behind


def _rise(steps: Steps, acceleration: Array) -> Array:
    """How much it jumps between two steps, of its size beside that."""
    before, behind = (np.einsum("ni,ni->n", side, acceleration) for side in (steps.right, steps.left))
    size = np.abs(acceleration).max(axis=1)
    found: Array = np.abs(behind[1:] - before[:-1]) / np.maximum(np.maximum(size[1:], size[:-1]), 1e-300)
    return found


def _varying(acceleration: Array) -> Array:
    """Without what is common to the rows of a step, which has no rate, but round-off."""
    found: Array = acceleration - acceleration[:, acceleration.shape[1] // 2, None]
    return found
