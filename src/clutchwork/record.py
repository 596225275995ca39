"""The loop over the compiled core: advance, make room, call controllers."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.control import Control
from clutchwork.failure import DONE, EVENTS_FULL, ROWS_FULL
from clutchwork.layout import EVENT

Array = NDArray[np.float64]
Progress = Callable[[float, float], None]

FIRST_CHUNK = 512
LARGEST_CHUNK = 16_384


class Recording:
    """What a run has written so far."""

    def __init__(self, run: Any) -> None:
        self.run = run
        self.status = DONE
        self.core_seconds = 0.0
        self._times: list[Array] = []
        self._rows: list[Array] = []
        self._events: list[Array] = []

    def advance(self, stop: float, times: Array, rows: Array, first: int, steps: bool) -> int:
        """Let the core run; the number of rows that are filled."""
        started = perf_counter()
        self.status, filled = self.run.advance(stop, times, rows, first, steps)
        self.core_seconds += perf_counter() - started
        return int(filled)

    def add(self, times: Array, rows: Array) -> None:
        """Append output rows and the events up to now."""
        if len(times):
            self._times.append(times)
            self._rows.append(rows)
        happened = np.asarray(self.run.events())
        if len(happened):
            self._events.append(happened)

    @property
    def times(self) -> Array:
        """Instants of the rows [s]."""
        return np.concatenate(self._times) if self._times else np.empty(0)

    @property
    def rows(self) -> Array:
        """Output rows, shape (instants, row size)."""
        return np.concatenate(self._rows) if self._rows else np.empty((0, len(self.run.row())))

    @property
    def events(self) -> Array:
        """Events, shape (events, columns of layout.EVENT)."""
        return np.concatenate(self._events) if self._events else np.empty((0, len(EVENT)))


def record(recording: Recording, t_end: float, grid: Array | None, control: Control, progress: Progress | None) -> None:
    """Run to the end, or until the core stops; a grid of None records the solver's steps."""
    begin = 0.0
    for stop in control.stops(t_end):
        acted = control.act(recording.run, begin)
        if grid is None:
            _steps(recording, stop, t_end, begin > 0.0 and acted, progress)
        else:
            _grid(recording, stop, t_end, _part(grid, begin, stop, stop == t_end), progress)
        if recording.status != DONE:
            return
        begin = stop


def _steps(recording: Recording, stop: float, t_end: float, acted: bool, progress: Progress | None) -> None:
    """Record every step of the solver, in buffers that grow."""
    run, size = recording.run, FIRST_CHUNK
    if acted:
        recording.add(np.array([run.time]), np.array(run.row()).reshape(1, -1))
    while True:
        times, rows = np.empty(size), np.empty((size, len(run.row())))
        filled = recording.advance(stop, times, rows, 0, True)
        recording.add(times[:filled].copy(), rows[:filled].copy())
        if progress is not None:
            progress(run.time, t_end)
        if recording.status not in (ROWS_FULL, EVENTS_FULL):
            return
        size = min(2 * size, LARGEST_CHUNK)


def _grid(recording: Recording, stop: float, t_end: float, times: Array, progress: Progress | None) -> None:
    """Record the given instants, all of them up to the stop."""
    run, filled = recording.run, 0
    rows = np.empty((len(times), len(run.row())))
    while True:
        filled = recording.advance(stop, times, rows, filled, False)
        if progress is not None:
            progress(run.time, t_end)
        if recording.status not in (ROWS_FULL, EVENTS_FULL):
            break
        recording.add(times[:0], rows[:0])
    recording.add(times[:filled], rows[:filled])


def _part(grid: Array, begin: float, stop: float, last: bool) -> Array:
    """Instants of one stretch: its own end belongs to it only at the end of the run, or as left limit."""
    first = int(np.searchsorted(grid, begin, "left"))
    if begin > 0.0 and int(np.searchsorted(grid, begin, "right")) - first > 1:
        first += 1
    if last:
        return grid[first:]
    end = int(np.searchsorted(grid, stop, "left"))
    doubled = int(np.searchsorted(grid, stop, "right")) - end > 1
    return grid[first : end + doubled]
