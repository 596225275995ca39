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
    times, moved = list[float](), list[Array]()
    numbers = slopes.matrix.shape[1]

    def of(word: int) -> Array:
        place = int(np.searchsorted(slopes.places, word))
        there = place < len(slopes.places) and slopes.places[place] == word
        return slopes.matrix[place] if there else np.zeros(numbers)

    for number, (first, count) in enumerate(_segments(system)):
        at_period = starts["input_period"] // 8 + number
        period = float(words[at_period])
        for word in range(starts["segment_time"] // 8 + first, starts["segment_time"] // 8 + first + count):
            repeats = int(min(MOST_REPEATS, max(0.0, (end - words[word]) // period))) if period > 0.0 else 0
            for repeat in range(repeats + 1) if np.any(of(word)) or np.any(of(at_period)) else ():
                time = float(words[word]) + repeat * period
                if begin < time < end:
                    times.append(time)
                    moved.append(of(word) + repeat * of(at_period))
    return Knots(np.array(times), np.array(moved).reshape(len(times), numbers))


def _segments(system: System) -> list[tuple[int, int]]:
    return list(zip(system.arrays["input_first"].tolist(), system.arrays["input_count"].tolist(), strict=True))
