"""How the integral of the square of the jerk changes: docs/theory/gradients.md (15) and (16)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import wiring
from clutchwork.gradients.functional import Functional
from clutchwork.gradients.instants import add_shift
from clutchwork.gradients.primal import EVENT, KNOT, SMOOTH, Primal
from clutchwork.gradients.signals import add_signal
from clutchwork.gradients.steps import Steps
from clutchwork.sweeps.parts import PARTS

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[np.float64]
Places = NDArray[np.intp]

# jumps of accelerations, and of their slopes, that are more than what polynomials miss: of the larger side
JUMP, BEND = 1e-6, 1e-4
# what a cubic, which slopes of a dense output of fourth order are, misses of its own slope at an end, over its last
# coefficient: seen at steps on shafts without inertia at tolerances from 1e-12 to 1e-8
MISSED = 0.1


def add_jerk(primal: Primal, signal: str, acceleration: Array, into: Functional) -> None:
    """How it changes: inside of the steps, and by the instants between them, which move.

    Parameters: acceleration, a line for the rows of each step.
    """
    steps = primal.steps
    inside = 2.0 * np.einsum("nij,nj->ni", steps.squared_slope, _varying(acceleration))
    before, behind = (side[1:-1] for side in _limits(steps, acceleration))
    known = np.isin(primal.between[0][1:], (EVENT, KNOT))
    jumps = steps.jumps[1:] & (_rise(steps, acceleration) > JUMP)
    smooth = ~known & ~jumps
    # one that goes on smoothly, as that of a prescribed motion does at a knot of a torque, moves with none
    own = known & ~jumps & (np.abs(behind - before) <= _lost(steps, acceleration))
    # what moves an instant at which it bends makes both limits differ at a fixed time: it need not be known
    share = np.where(smooth, before + behind, 0.0)[:, None]
    rows = np.concatenate([steps.rows, steps.rows[1:], steps.rows[:-1]])
    weights = np.concatenate([inside, share * steps.left[1:], -share * steps.right[:-1]])
    add_signal(primal, signal, rows.ravel(), weights.ravel(), into)
    for step in np.flatnonzero(~smooth & ~own):
        add_shift(primal, int(step) + 1, float(before[step] ** 2 - behind[step] ** 2), into)


def seen(steps: Steps, acceleration: Array) -> float:
    """What the rows of the steps say of its value: steps too short for runs with derivatives have none."""
    varying = _varying(acceleration)
    return float(np.einsum("nij,ni,nj->", steps.squared_slope, varying, varying))


def bends_in(steps: Steps, acceleration: Array, turning: Places) -> float:
    """By how much bends inside of steps would change it, which moved by as much as they are behind the start."""
    if not len(turning):
        return 0.0
    before, behind = _limits(steps, acceleration)
    jumps = np.abs(before[turning] ** 2 - behind[turning + 1] ** 2)
    return float(jumps @ (steps.begin[turning] - steps.begin[0]))


def missed(primal: Primal, signal: str, acceleration: Array, *, is_massless: bool) -> list[tuple[Functional, float]]:
    """What moves and has another jerk on both sides, and how little is known of that there.

    Parameters: is_massless, of a shaft without inertia, whose accelerations are slopes of the dense output.
    """
    steps, found = primal.steps, list[tuple[Functional, float]]()
    before, behind = _limits(steps, acceleration)
    degree = PARTS - 1 if is_massless else PARTS
    last = MISSED * np.abs(np.einsum("ni,ni->n", steps.basis[:, degree], acceleration)) / steps.length
    bends = np.r_[False, np.abs(behind - before)[1:-1] > last[1:] + last[:-1]]
    # of an event with which the first step begins the other side is too short to be seen
    moved = np.r_[False, primal.between[0][1:] != SMOOTH]
    for step in np.flatnonzero(bends | moved).tolist():
        moves, lost = primal.functional(), (float(last[step - 1]), float(last[step]))
        if primal.between[0][step] != SMOOTH:
            add_shift(primal, step, 1.0, moves)
            found.append((moves, 2.0 * (abs(float(before[step])) * lost[0] + abs(float(behind[step])) * lost[1])))
        else:
            rows, weights = steps.rows[[step, step - 1]], np.concatenate([steps.left[step], -steps.right[step - 1]])
            add_signal(primal, signal, rows.ravel(), weights, moves)
            found.append((moves, sum(lost)))
    return found


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


def _lost(steps: Steps, acceleration: Array) -> Array:
    """By how much both limits of the jerk at an instant may differ because polynomials have no more coefficients."""
    last = np.einsum("ni,ni->n", steps.basis[:, PARTS], acceleration) / steps.length
    # where the last one passes zero it says nothing: by how much it changes does
    cubes = steps.length**3
    change = np.abs(np.diff(last / cubes)) * np.minimum(cubes[1:], cubes[:-1])
    found: Array = MISSED * (np.abs(last[1:]) + np.abs(last[:-1]) + 2.0 * change)
    return found


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


def massless(system: System) -> frozenset[str]:
    """Accelerations of shafts that move with a speed without inertia."""
    arrays, found, first = system.arrays, list[str](), 0
    for node, end in zip(wiring(system).nodes, arrays["basis_end"].tolist(), strict=True):
        if np.any(arrays["massless"][arrays["basis_column"][first:end]]):
            found.append(f"{node.name}.acceleration")
        first = end
    return frozenset(found)
