"""Instants at which signals jump: there a trajectory shows both limits."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.memoize import memoize
from clutchwork.signals.bases.waveform import piece_value

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Segment, Signal

# a train of pulses with more jumps than this is drawn well enough without both limits
MOST_JUMPS = 10_000


def jump_times(system: System, begin: float, t_end: float) -> NDArray[np.float64]:
    """Instants inside (begin, t_end) at which at least one signal of a System jumps [s], each once."""
    found = {time for at, period in _jumping(system) for time in _repeated(at, period, begin, t_end)}
    return np.array(sorted(found))


@memoize
def _jumping(system: System) -> tuple[tuple[list[float], float], ...]:
    """Of each signal that jumps the instants at which it first does, and the period of those that repeat, 0: never."""
    found = ((_jumps(item.signal), item.signal.repeats()) for item in system.inputs)
    return tuple((at, period) for at, period in found if at)


def _jumps(signal: Signal) -> list[float]:
    pieces, period = list(signal.segments()), signal.repeats()
    if period > 0.0:
        # the first piece follows the last one in every repetition
        pieces.append(pieces[0]._replace(start=pieces[0].start + period))
    return [after.start for before, after in pairwise(pieces) if _differ(before, after)]


def _repeated(at: list[float], period: float, begin: float, t_end: float) -> list[float]:
    repeats = np.zeros(1)
    if period > 0.0:
        # the repetition before the begin reaches into the run
        before = float(max(0, math.floor((begin - at[0]) / period) - 1))
        repeats = (before + np.arange(0.0, min((t_end - begin) / period, MOST_JUMPS) + 3.0)) * period
    times: NDArray[np.float64] = np.add.outer(np.array(at, dtype=float), repeats).ravel()
    inside: list[float] = times[(times > begin) & (times < t_end)][:MOST_JUMPS].tolist()
    return inside


def _differ(before: Segment, after: Segment) -> bool:
    """Whether a signal has two limits where one piece meets the next, beyond round-off."""
    left, right = piece_value(before, after.start), piece_value(after, after.start)
    return abs(left - right) > 1e-9 * max(abs(left), abs(right))
