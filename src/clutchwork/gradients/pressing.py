"""Loads that are exactly zero for a while and may be more: a little more presses, a little less does not."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.declare.schema import inputs

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.chart import Chart, Slopes

Array = NDArray[np.float64]

# numbers of a piece of a signal
PIECE = 12


def at_rest(chart: Chart, words: Array, slopes: Slopes, names: Sequence[str], end: float) -> Iterator[str]:
    """What is said of pieces of loads that are zero, and numbers that would make them more."""
    system, starts = chart.assembled.system, chart.assembled.structure.layout.starts
    time, first = starts["segment_time"] // 8, starts["segment_coef"] // 8
    for number in pressing(system):
        begin, count = (int(system.arrays[f"input_{what}"][number]) for what in ("first", "count"))
        pieces = words[first + PIECE * begin : first + PIECE * (begin + count)].reshape(count, PIECE)
        bounds = np.r_[words[time + begin : time + begin + count], np.inf]
        for piece in np.flatnonzero(~pieces[:, :4].any(axis=1) & ~pieces[:, [4, 8]].any(axis=1)).tolist():
            coefficients = first + PIECE * (begin + piece) + np.arange(4)
            moved = slopes.matrix[np.isin(slopes.places, coefficients)].any(axis=0)
            if moved.any() and bounds[piece] < end and bounds[piece + 1] > 0.0:
                free = ", ".join(names[column] for column in np.flatnonzero(moved).tolist())
                until = f"{min(float(bounds[piece + 1]), end):g} s"
                what = f"{system.inputs[number].name} is 0 from {max(bounds[piece], 0.0):g} to {until}"
                yield f"{what}, where derivatives by {free} are those of an open contact; give a little more than 0"


def pressing(system: System) -> Iterator[int]:
    """Numbers of the signals that press contacts."""
    known = {item.name: number for number, item in enumerate(system.inputs)}
    for contact in system.contacts:
        for names, spec in inputs(type(contact)):
            for name in names if spec.presses or spec.gain else ():
                if f"{contact.name}.{name}" in known:
                    yield known[f"{contact.name}.{name}"]
