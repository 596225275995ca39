"""Instants at which signals jump: there a trajectory shows both limits."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.signals.bases.waveform import piece_value

if TYPE_CHECKING:
    from clutchwork.assembly.records import Input
    from clutchwork.declare.node import Segment, Signal

# a train of pulses with more jumps than this is drawn well enough without both limits
MOST_JUMPS = 10_000


def jump_times(inputs: Sequence[Input], t_end: float) -> NDArray[np.float64]:
    """Instants inside (0, t_end) at which at least one signal jumps [s], each once."""
    found = [_jumps(item.signal, t_end) for item in inputs]
    return np.unique(np.concatenate([np.empty(0), *found]))


def _jumps(signal: Signal, t_end: float) -> NDArray[np.float64]:
    pieces, period = list(signal.segments()), signal.repeats()
    if period > 0.0:
        # the first piece follows the last one in every repetition
        pieces.append(pieces[0]._replace(start=pieces[0].start + period))
    at = [after.start for before, after in pairwise(pieces) if _differ(before, after)]
    repeats = np.arange(0.0, min(t_end / period, MOST_JUMPS) + 1.0) * period if period > 0.0 else np.zeros(1)
    times: NDArray[np.float64] = np.add.outer(np.array(at, dtype=float), repeats).ravel()
    return times[(times > 0.0) & (times < t_end)][:MOST_JUMPS]


def _differ(before: Segment, after: Segment) -> bool:
    """Whether a signal has two limits where one piece meets the next, beyond round-off."""
    left, right = piece_value(before, after.start), piece_value(after, after.start)
    return abs(left - right) > 1e-9 * max(abs(left), abs(right))
