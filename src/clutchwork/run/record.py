"""The loop over the compiled core: advance, make room, call controllers."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.declare.layout import DONE, EVENT, EVENTS_FULL, INTERRUPTED, ROWS_FULL

if TYPE_CHECKING:
    from clutchwork.run.input_schedule import Schedule

Progress = Callable[[float, float], None]
Told = Callable[[float], None]

FIRST_CHUNK = 512
LARGEST_CHUNK = 16_384
# a longer grid is cut into stretches, so that progress can be told
LONG_GRID = 100_000


class Recording:
    """What a run has written so far."""

    def __init__(self, run: Any, continued: bool = False, look: Callable[[], Array] | None = None) -> None:
        self.run = run
        self.row_size = int(run.row_size)
        self.continued = continued  # whether it goes on from a state
        self.look = look or run.row  # the row at the present time
        self.status = DONE
        self.raised: BaseException | None = None  # by a signal handler, such as Ctrl-C
        self.core_seconds = 0.0
        self._before = run.statistics()
        self._parts: list[tuple[Array, Array]] = []
        self._events: list[Array] = []

    def advance(self, stop: float, times: Array, rows: Array, first: int, steps: bool, spacing: float = 0.0) -> int:
        """Let the core run; the number of rows that it added."""
        started = perf_counter()
        between = (spacing,) if spacing else ()
        self.status, filled, self.raised = self.run.advance(stop, times, rows, first, steps, *between)
        if self.raised is not None:
            self.status = INTERRUPTED
        self.core_seconds += perf_counter() - started
        return int(filled)

    def add(self, times: Array, rows: Array) -> None:
        """Append output rows and the events up to now."""
        if len(times):
            self._parts.append((times, rows))
        happened = np.asarray(self.run.events())
        if len(happened):
            self._events.append(happened)

    def counts(self) -> dict[str, int]:
        """What the core has counted since the begin."""
        return {name: count - self._before[name] for name, count in self.run.statistics().items()}

    @property
    def times(self) -> Array:
        """Instants of the rows [s]."""
        return _joined([times for times, _ in self._parts], np.empty(0))

    @property
    def rows(self) -> Array:
        """Output rows, shape (instants, row size)."""
        return _joined([rows for _, rows in self._parts], np.empty((0, self.row_size)))

    @property
    def events(self) -> Array:
        """Events, shape (events, columns of layout.EVENT)."""
        return _joined(self._events, np.empty((0, len(EVENT))))


def _joined(parts: list[Array], nothing: Array) -> Array:
    """Parts one after another; one alone as it is, not copied."""
    return parts[0] if len(parts) == 1 else np.concatenate([nothing, *parts])


def record(
    recording: Recording,
    t_end: float,
    grid: Array | None,
    course: Schedule,
    progress: Told | None,
    spacing: float = 0.0,
) -> None:
    """Run to the end, or until the core stops; a grid of None records the solver's steps.

    Parameters: spacing, of steps that are longer also instants between their ends [s]; 0: of none.
    """
    run = recording.run
    start = begin = run.time
    # one that goes on from a state does not give its first row by itself
    for number, stop in enumerate(course.stops(begin, t_end)):
        acted = course.act(run, begin, number) or (number == 0 and recording.continued)
        if grid is None:
            _steps(recording, stop, acted, progress, spacing)
        else:
            _grid(recording, stop, _part(grid, begin, stop, begin == start, stop == t_end), progress)
        if recording.status != DONE:
            return
        begin = stop


def _steps(recording: Recording, stop: float, acted: bool, progress: Told | None, spacing: float) -> None:
    """Record every step of the solver, in buffers that grow."""
    run, size = recording.run, FIRST_CHUNK
    skip_at = -1.0
    if acted:
        # the right limit after the controllers; the core may give it once more
        skip_at = run.time
        recording.add(np.array([skip_at]), np.array(recording.look()).reshape(1, -1))
    while True:
        # the core takes no less than what the rest of the run may fill
        count = size + (int((stop - run.time) / spacing) + 4 if spacing else 0)
        times, rows = np.empty(count), np.empty((count, recording.row_size))
        filled = recording.advance(stop, times, rows, 0, True, spacing)
        first = int(np.searchsorted(times[:filled], skip_at, "right"))
        recording.add(*_cut(times, rows, first, filled))
        if progress is not None:
            progress(run.time)
        if recording.status not in (ROWS_FULL, EVENTS_FULL):
            return
        size = min(2 * size, LARGEST_CHUNK)


def _cut(times: Array, rows: Array, first: int, last: int) -> tuple[Array, Array]:
    """Some of the rows; alone, where most of their memory would be kept for nothing."""
    some = times[first:last], rows[first:last]
    return some if 2 * (last - first) > len(times) else (some[0].copy(), some[1].copy())


def _grid(recording: Recording, stop: float, times: Array, progress: Told | None) -> None:
    """Record the given instants, all of them up to the stop."""
    # each stretch ends in a step of its own, so that there are stretches only if progress is reported
    told = progress is not None and len(times) > LONG_GRID
    cuts = range(LARGEST_CHUNK, len(times), LARGEST_CHUNK) if told else ()
    first = 0
    for cut in cuts:
        _stretch(recording, float(times[cut]), times[first:cut])
        if progress is not None:
            progress(recording.run.time)
        if recording.status != DONE:
            return
        first = cut
    _stretch(recording, stop, times[first:])


def _stretch(recording: Recording, stop: float, times: Array) -> None:
    rows, filled = np.empty((len(times), recording.row_size)), 0
    while True:
        filled += recording.advance(stop, times, rows, filled, False)
        if recording.status not in (ROWS_FULL, EVENTS_FULL):
            recording.add(times[:filled], rows[:filled])
            return
        recording.add(times[:0], rows[:0])


def _part(grid: Array, begin: float, stop: float, at_start: bool, last: bool) -> Array:
    """Instants of one stretch: of its end once, the left limit as at any event; what is left is of the next one."""
    first, end = int(np.searchsorted(grid, begin, "left")), int(np.searchsorted(grid, stop, "left"))
    if not at_start and first < len(grid) and grid[first] == begin:
        first += 1
    if last:
        return grid[first:]
    return grid[first : end + int(end < len(grid) and grid[end] == stop)]
