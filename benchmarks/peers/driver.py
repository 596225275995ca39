"""The loop over stretches and events around a solver of one smooth phase, and the error of what comes out."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.peers import equations as eq

FOLDER = Path(__file__).parent
Array = np.ndarray


class Phase(NamedTuple):
    """One smooth phase that is to be solved: up to `stop`, or to the first guard that falls through zero."""

    start: float
    stop: float
    y: Array
    modes: Any
    k: int
    guards: list[int]
    dense: bool  # whether states in between are asked for


class Reached(NamedTuple):
    """Where a phase ended: at which guard, None at its stop; `at` gives states in between."""

    t: float
    y: Array
    hit: int | None
    at: Callable[[Array], Array] | None


def run(solve: Callable[[Phase], Reached], grid: Array | None = None) -> tuple[Array, list[tuple[float, int]]]:
    """The states on a grid, those at the end without one, and the events as (time, guard)."""
    y, modes, events, rows = np.zeros(eq.STATES), eq.START, [], []
    for k, (t, stop) in enumerate(zip(eq.KNOTS[:-1], eq.KNOTS[1:], strict=True)):
        while t < stop - 1e-13:
            guards = [i for i in range(4) if eq.watched(i, modes, k)]
            reached = solve(Phase(t, stop, y, modes, k, guards, grid is not None))
            if grid is not None and reached.at is not None:
                inside = grid[(grid >= t) & ((grid < reached.t) | (reached.t == eq.T_END))]
                rows += [reached.at(inside)] if inside.size else []
            t, y = reached.t, np.array(reached.y)
            if reached.hit is not None:
                modes = eq.switched(reached.hit, t, y.tolist(), modes, k)
                events.append((t, reached.hit))
                y[:4] = at_rest(y[:4], modes)
    return (y if grid is None else np.vstack(rows)), events


def at_rest(w: Array, modes: Any) -> Array:
    """The speeds without the slip that locked clutches are left with by round-off."""
    rows = np.array([row for row, mode in zip(eq.SLIPS, modes, strict=False) if mode == 0])
    if not len(rows):
        return w
    across = np.array(eq.MASS_INVERSE) @ rows.T
    return w - across @ np.linalg.solve(rows @ across, rows @ w)


@cache
def reference() -> tuple[Array, Array]:
    """Instants [s] and speeds [rad/s] of a solution at a relative tolerance of 1e-12, every millisecond."""
    data = np.loadtxt(FOLDER / "reference.csv", delimiter=",", skiprows=1)
    return data[:, 0], data[:, 1:5]


def error(speeds: Array) -> float:
    """Largest error of the four speeds on the grid of the reference [rad/s]."""
    return float(np.max(np.abs(speeds - reference()[1])))
