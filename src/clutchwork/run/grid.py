"""Instants at which the output of a run is wanted."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.errors import OptionError
from clutchwork.base.shown import shown
from clutchwork.declare.options import MOST_COUNTED, MOST_ROWS, Options


def output_grid(options: Options, t_end: float) -> NDArray[np.float64] | None:
    """The wanted output instants [s], or None when the solver's steps decide."""
    if options.dt is not None:
        return _uniform(options.dt, options.t_start, t_end)
    return None if options.times is None else _given(options.times, options.t_start, t_end)


def _uniform(dt: float, begin: float, t_end: float) -> NDArray[np.float64]:
    """begin, begin + dt ... and t_end; a last interval that is only round-off long is dropped."""
    instants = (t_end - begin) / dt * (1.0 + 1e-12)
    count = math.floor(instants) if math.isfinite(instants) else MOST_COUNTED
    if count > MOST_ROWS:
        fault = f"dt is {dt:g} s: {count:.6g} instants up to {t_end:g} s do not fit into memory; use a larger dt"
        raise OptionError([fault])
    grid: NDArray[np.float64] = np.minimum(begin + np.arange(count + 1) * dt, t_end)
    if t_end - grid[-1] > 1e-9 * dt:
        return np.append(grid, t_end)
    grid[-1] = t_end
    return grid


def _given(times: Sequence[float] | NDArray[np.float64], begin: float, t_end: float) -> NDArray[np.float64]:
    try:
        grid = np.array(times, dtype=float)
    except (TypeError, ValueError):
        raise OptionError([f"times are {shown(times)}: they must be a sequence of numbers [s]"]) from None
    if grid.ndim != 1 or grid.size == 0:
        raise OptionError(["times must hold at least one instant"])
    if not np.all(np.isfinite(grid)) or np.any(np.diff(grid) < 0.0):
        raise OptionError(["times must be finite and must not decrease; an instant given twice gets both limits there"])
    if grid[0] < begin or grid[-1] > t_end:
        first = f"t_start = {begin:g} s" if begin else "0"
        fault = f"times run from {grid[0]:g} to {grid[-1]:g} s: they must lie between {first} and t_end = {t_end:g} s"
        raise OptionError([fault])
    return grid
