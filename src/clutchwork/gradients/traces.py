"""Signals at many instants of a run with derivatives: all rows of a signal at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.run_point import Run
from clutchwork.sweeps.outputs import AtEnd, AtTimes

Array = NDArray[np.float64]
Places = NDArray[np.intp]


def trace(run: Run, one: AtTimes | AtEnd) -> tuple[Places, Array, Array]:
    """Columns, values and derivatives of a signal at its instants, or at the end, of a forward run."""
    primal, tangents = run.primal, run.tangents
    end = primal.row(primal.t_end)
    rows = primal.times.searchsorted(one.times) if isinstance(one, AtTimes) else slice(end, end + 1)
    form, picked = primal.forms[one.signal], primal.rows[rows]
    known, matrix = form.weights(picked), np.zeros((len(picked), primal.numbers))
    for column, line in zip(known.columns.tolist(), known.values.T, strict=True):
        matrix += line[:, None] * tangents[rows, column]
    if one.signal in primal.bent:
        matrix += primal.bent[one.signal][rows]
    return known.columns, np.asarray(form(picked), dtype=float), matrix
