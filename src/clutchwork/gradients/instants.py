"""How the instants between two steps move with the numbers: docs/theory/gradients.md (3)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.functional import Functional
from clutchwork.gradients.primal import EVENT, KINK, KNOT, Primal

Array = NDArray[np.float64]

# of a speed: what slopes of rows do not see
ROUND_OFF = 1e-14


def add_shift(primal: Primal, step: int, share: float, into: Functional) -> None:
    """Add a share of the derivative of the instant at which a step begins."""
    kind, number = (int(found[step]) for found in primal.between)
    if kind in (EVENT, KINK):
        into.add_event(number, share)
    elif kind == KNOT and number >= 0:
        into.direct += share * primal.knots.moved[number]


def missed(primal: Primal, step: int, *, at_end: bool) -> float:
    """Relative error of the slopes of the dense output at an end of a step: slopes of speeds against accelerations.

    Each shaft counts by its own acceleration in the step, so that a fast one beside it hides nothing.
    """
    steps, rows = primal.steps, primal.rows[primal.steps.rows[step]]
    slopes, limits = (steps.right_slope, steps.right) if at_end else (steps.left_slope, steps.left)
    speeds, accelerations = rows[:, primal.columns["speed"]], rows[:, primal.columns["acceleration"]]
    noise = ROUND_OFF * np.abs(speeds).max(axis=0) / steps.length[step]
    apart = np.maximum(np.abs(slopes[step] @ speeds - limits[step] @ accelerations) - noise, 0.0)
    sizes = np.abs(accelerations).max(axis=0)
    return float((apart / np.maximum(sizes, 1e-9 * max(float(sizes.max(initial=0.0)), 1e-291))).max(initial=0.0))


def add_turn(primal: Primal, capacity: str, step: int, share: float, into: Functional) -> None:
    """Add a share of the derivative of the instant at which a capacity jumps as its torque reverses."""
    steps, known = primal.steps, primal.columns["contact_capacity"]
    columns, rows = primal.forms[capacity].weights(primal.rows[:1]).columns, steps.rows[step]
    if len(columns) != 1 or not known.start <= columns[0] < known.stop:
        return
    place = columns - known.start + primal.columns["contact_torque"].start
    rate = float(steps.left_slope[step] @ primal.rows[rows, int(place[0])])
    if rate == 0.0:
        return
    into.add(rows, place, (-share / rate * steps.left[step])[:, None])
