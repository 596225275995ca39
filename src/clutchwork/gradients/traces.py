"""Signals at many instants of a run with derivatives: all rows of a signal at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.runs import Run
from clutchwork.gradients.signals import signal_at
from clutchwork.sweeps.outputs import AtEnd, AtTimes

Array = NDArray[np.float64]
Places = NDArray[np.intp]


def trace(run: Run, one: AtTimes | AtEnd) -> tuple[Places, Array, Array]:
    """Columns, values and derivatives of a signal at its instants, or at the end, of a forward run."""
    primal, tangents = run.primal, run.tangents
    rows = np.searchsorted(primal.times, one.times if isinstance(one, AtTimes) else [primal.t_end])
    known, matrix = primal.forms[one.signal].weights(primal.rows[rows]), np.zeros((len(rows), primal.numbers))
    for column, line in zip(known.columns.tolist(), known.values.T, strict=True):
        matrix += line[:, None] * tangents[rows, column]
    if one.signal in primal.bent:
        matrix += primal.bent[one.signal][rows]
    return known.columns, signal_at(primal, one.signal, rows), matrix
