"""Knots of signals whose times move with the numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.chart import Chart, Slopes
from clutchwork.gradients.primal import Knots

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[np.float64]

# repetitions of a signal that are looked at
MOST_REPEATS = 100_000


def knots(chart: Chart, words: Array, slopes: Slopes, begin: float, end: float) -> Knots:
    """All that move, up to the end of a run."""
    system, starts = chart.assembled.system, chart.assembled.structure.layout.starts
    first, at_period = starts["segment_time"] // 8, starts["input_period"] // 8
    periods = at_period + np.arange(len(system.arrays["input_period"]))
    free, known = _moving(slopes, first, len(system.arrays["segment_time"])), slopes.places
    if not len(free) and not np.any(np.isin(periods, known)):
        return Knots(np.zeros(0), np.zeros((0, slopes.matrix.shape[1])))
    times, moved = list[float](), list[Array]()
    for number, (segment, count) in enumerate(_segments(system)):
        period, by_period = float(words[at_period + number]), _of(slopes, at_period + number)
        for word in range(first + segment, first + segment + count):
            by_time = _of(slopes, word)
            if not np.any(by_time) and not np.any(by_period):
                continue
            repeats = int(min(MOST_REPEATS, max(0.0, (end - words[word]) // period))) if period > 0.0 else 0
            there = float(words[word]) + np.arange(repeats + 1) * period
            for repeat in np.flatnonzero((begin < there) & (there < end)).tolist():
                times.append(float(there[repeat]))
                moved.append(by_time + repeat * by_period)
    return Knots(np.array(times), np.array(moved).reshape(len(times), slopes.matrix.shape[1]))


def _moving(slopes: Slopes, first: int, count: int) -> NDArray[np.int64]:
    """Words of times of knots that change."""
    inside = (slopes.places >= first) & (slopes.places < first + count)
    return slopes.places[inside][slopes.matrix[inside].any(axis=1)]


def _of(slopes: Slopes, word: int) -> Array:
    """Derivatives of a word."""
    place = int(np.searchsorted(slopes.places, word))
    there = place < len(slopes.places) and slopes.places[place] == word
    found: Array = slopes.matrix[place] if there else np.zeros(slopes.matrix.shape[1])
    return found


def _segments(system: System) -> list[tuple[int, int]]:
    return list(zip(system.arrays["input_first"].tolist(), system.arrays["input_count"].tolist(), strict=True))
