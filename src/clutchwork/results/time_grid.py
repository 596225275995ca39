"""Instants that are equally far apart, and a run at other instants than its own."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import OptionError, quote
from clutchwork.base.arrays import Array
from clutchwork.declare.options import MOST_COUNTED, MOST_ROWS, ONE_GRID, Options, instants
from clutchwork.declare.units import split

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded


def uniform(dt: float, begin: float, t_end: float) -> Array:
    """begin, begin + dt ... and t_end; a last interval that is only round-off long is dropped."""
    instants = (t_end - begin) / dt * (1.0 + 1e-12)
    count = math.floor(instants) if math.isfinite(instants) else MOST_COUNTED
    if count > MOST_ROWS:
        fault = f"dt is {dt:g} s: {count:.6g} instants up to {t_end:g} s do not fit into memory; use a larger dt"
        raise OptionError([fault])
    grid: Array = np.minimum(begin + np.arange(count + 1) * dt, t_end)
    if t_end - grid[-1] > 1e-9 * dt:
        return np.append(grid, t_end)
    grid[-1] = t_end
    return grid


def at_raster(run: Recorded, dt: float | None, times: Any) -> Recorded:
    """The run at instants that are asked for: computed again, not interpolated; as it is where none are.

    Parameters: dt, distance of the instants [s]; times, the instants [s].
    """
    if dt is None and times is None:
        return run
    if dt is not None and times is not None:
        raise OptionError([f"dt and times are both given: {ONE_GRID}"])
    if not len(run):
        raise OptionError(["this run has no instant: leave dt and times out"])
    first, last = float(run.time[0]), float(run.time[-1])
    if dt is None:
        return run.at(_within(times, first, last))
    grid = uniform(float(Options(dt=dt).dt or 0.0), run.options.t_start, last)
    inside = grid[grid >= first]
    return run.at(inside if inside.size and inside[0] == first else np.append(first, inside))


def _within(times: Any, first: float, last: float) -> Array:
    """Instants in order that lie within the run."""
    given = times if isinstance(times, str) and not split(times) else instants(times)
    try:
        grid = np.sort(np.atleast_1d(np.array(given, dtype=float)))
    except (TypeError, ValueError):
        raise OptionError([f"times are {quote(times)}: they must be a sequence of numbers [s]"]) from None
    if grid.ndim != 1 or not grid.size or not np.all(np.isfinite(grid)):
        raise OptionError(["times must be a list of finite numbers [s], at least one"])
    if grid[0] < first or grid[-1] > last:
        fault = f"times run from {grid[0]:g} to {grid[-1]:g} s: they must lie between {first:g} and {last:g} s"
        raise OptionError([f"{fault}, where the run begins and ends"])
    return grid
