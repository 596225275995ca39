"""Runs that begin at a knot that moves: for a later one they begin on the piece before it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

from clutchwork.gradients.beginning import PIECE
from clutchwork.gradients.knots import ONE_INSTANT
from clutchwork.gradients.words import Chart, Slopes

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# coefficients of a piece that are those of its polynomial; what is behind them is a wave
CUBIC = 4
# what a signal may differ by on both sides of a knot without a jump, of its size
JUMP = 1e-9


def begun_at_knots(chart: Chart, words: Array, slopes: Slopes, begin: float) -> Iterator[tuple[str, Mask]]:
    """What is said of signals that have a knot there with which speeds or torques jump, and the numbers that move it.

    A prescribed speed gives the run another start on the piece before; a torque that only bends there does not.
    """
    (first, pieces), system = chart.words_in("segment_time"), chart.assembled.system
    times = words[first : first + pieces]
    at_begin = np.flatnonzero(np.abs(times - begin) <= ONE_INSTANT * (1.0 + abs(begin)))
    if not len(at_begin) or not slopes.touch(first, pieces):
        return
    starts, prescribed = system.arrays["input_first"], set(system.arrays["prescribed_input"].tolist())
    for place in at_begin.tolist():
        number = int(np.searchsorted(starts, place, side="right")) - 1
        numbers: Mask = slopes.of(np.array([first + place]))[0] != 0.0
        if numbers.any() and (number in prescribed or (place > starts[number] and _jumps(chart, words, place))):
            name = system.inputs[number].name
            yield (
                f"{name} has a knot at {begin:.9g} s, where the run begins, that moves; move it, or begin elsewhere",
                numbers,
            )


def _jumps(chart: Chart, words: Array, place: int) -> bool:
    """Whether a piece begins with another value than the one before ends with."""
    first = chart.words_in("segment_coef")[0] + PIECE * place
    time = chart.words_in("segment_time")[0] + place
    before, own = words[first - PIECE : first], words[first : first + PIECE]
    if before[CUBIC] != 0.0 or own[CUBIC] != 0.0:
        return True
    end = float(polyval(words[time] - words[time - 1], before[:CUBIC]))
    return abs(end - float(own[0])) > JUMP * max(abs(end), abs(float(own[0])))
