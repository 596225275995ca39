"""Knots of signals whose times move with the numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.memoize import memoize
from clutchwork.gradients.assembled import words_of
from clutchwork.gradients.primal import Knots
from clutchwork.gradients.words import Chart, Slopes

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[np.float64]

# arrays that say when knots are
TIMES = ("segment_time", "input_period")
# repetitions of a signal that are looked at
MOST_REPEATS = 100_000

# knots that are as close are at one instant, and derivatives of instants that are as alike move together
ONE_INSTANT, ALIKE = 1e-12, 1e-9


def knots(chart: Chart, words: Array, slopes: Slopes, begin: float, end: float) -> Knots:
    """All that move, up to the end of a run, and where they meet others."""
    (first, pieces), (at_period, signals) = map(chart.words_in, TIMES)
    width = slopes.matrix.shape[1]
    if chart.stays(*TIMES) or not (
        slopes.matrix[slopes.within(first, pieces)].any() or slopes.touch(at_period, signals)
    ):
        return Knots(np.zeros(0), np.zeros((0, width)), np.zeros(0), np.array(times_of(chart, words, end)))
    times, moved = [np.zeros(0)], [np.zeros((0, width))]
    for number, (segment, count) in enumerate(_segments(chart.assembled.system)):
        period, by_period = float(words[at_period + number]), _of(slopes, at_period + number)
        for word in range(first + segment, first + segment + count):
            cycles = np.arange(_repeats(float(words[word]), period, end) + 1.0)
            times.append(float(words[word]) + cycles * period)
            moved.append(_of(slopes, word) + cycles[:, None] * by_period)
    return _met(np.concatenate(times), np.concatenate(moved), begin, end)


def times_of(chart: Chart, words: Array, end: float) -> list[float]:
    """Instants of the knots of all signals up to the end of a run [s], in order."""
    return _still_times(chart, end) if chart.stays(*TIMES) else _times(chart, words, end)


@memoize
def _still_times(chart: Chart, end: float) -> list[float]:
    return _times(chart, words_of(chart.assembled.system), end)


def _times(chart: Chart, words: Array, end: float) -> list[float]:
    (first, pieces), (at_period, signals) = map(chart.words_in, TIMES)
    if max(words[at_period : at_period + signals].tolist(), default=0.0) <= 0.0:
        return sorted(words[first : first + pieces].tolist())
    found = [np.zeros(0)]
    for number, (segment, count) in enumerate(_segments(chart.assembled.system)):
        begins, period = words[first + segment : first + segment + count], float(words[at_period + number])
        cycles = np.arange(_repeats(float(begins.min(initial=end)), period, end) + 1.0)
        found.append((begins + cycles[:, None] * period).ravel())
    return sorted(np.concatenate(found).tolist())


def _repeats(begin: float, period: float, end: float) -> int:
    """How often a piece that begins at an instant comes again."""
    return int(min(MOST_REPEATS, max(0.0, (end - begin) // period))) if period > 0.0 else 0


def _met(times: Array, moved: Array, begin: float, end: float) -> Knots:
    """Knots that move inside of a run, from all that there are."""
    order = np.argsort(times, kind="stable")
    times, moved = times[order], moved[order]
    moves: NDArray[np.bool_] = np.any(moved != 0.0, axis=1)
    room = ONE_INSTANT * (1.0 + np.abs(times))
    at_ends = moves & ((np.abs(times - begin) <= room) | (np.abs(times - end) <= room))
    close = np.flatnonzero((np.diff(times) <= room[1:]) & (moves[1:] | moves[:-1]))
    apart = np.abs(moved[close + 1] - moved[close]).max(axis=1, initial=0.0)
    meeting = close[apart > ALIKE * np.abs(moved[close]).max(axis=1, initial=0.0)]
    meets = np.unique(np.concatenate([times[at_ends], times[meeting]]))
    inside = moves & (begin < times) & (times < end)
    within = (begin - room.max() <= meets) & (meets <= end + room.max())
    return Knots(times[inside], moved[inside], meets[within], times)


def _of(slopes: Slopes, word: int) -> Array:
    """Derivatives of a word."""
    found: Array = slopes.matrix[slopes.within(word, 1)].sum(axis=0)
    return found


def _segments(system: System) -> list[tuple[int, int]]:
    return list(zip(system.arrays["input_first"].tolist(), system.arrays["input_count"].tolist(), strict=True))
