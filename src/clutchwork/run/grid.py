"""Instants at which the output of a run is wanted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import OptionError, quote
from clutchwork.declare.options import Options, instants
from clutchwork.results.time_grid import uniform


def output_grid(options: Options, t_end: float) -> NDArray[np.float64] | None:
    """The wanted output instants [s], or None when the solver's steps decide."""
    if options.dt is not None:
        return uniform(options.dt, options.t_start, t_end)
    return None if options.times is None else _given(options.times, options.t_start, t_end)


def _given(times: Sequence[float] | NDArray[np.float64], begin: float, t_end: float) -> NDArray[np.float64]:
    given = times if isinstance(times, str) else instants(times)
    try:
        grid = np.array(given, dtype=float)
    except (TypeError, ValueError):
        raise OptionError([f"times are {quote(times)}: they must be a sequence of numbers [s]"]) from None
    if grid.ndim != 1 or grid.size == 0:
        raise OptionError(["times must hold at least one instant"])
    if not np.all(np.isfinite(grid)) or np.any(np.diff(grid) < 0.0):
        raise OptionError(["times must be finite and must not decrease; an instant given twice gets both limits there"])
    if grid[0] < begin or grid[-1] > t_end:
        first = f"t_start = {begin:g} s" if begin else "0"
        fault = f"times run from {grid[0]:g} to {grid[-1]:g} s: they must lie between {first} and t_end = {t_end:g} s"
        raise OptionError([fault])
    return grid
