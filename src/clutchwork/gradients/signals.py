"""Signals in rows of a run, and how weighted sums of them change."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.functional import Functional
from clutchwork.gradients.primal import Primal

Array = NDArray[np.float64]
Places = NDArray[np.intp]


def signal_at(primal: Primal, name: str, rows: Places) -> Array:
    """A signal in some rows."""
    found: Array = np.asarray(primal.forms[name](primal.rows[rows.ravel()]), dtype=float)
    return found.reshape(rows.shape)


def add_signal(primal: Primal, name: str, rows: Places, shares: Array, into: Functional) -> None:
    """Add a weighted sum of a signal in some rows: a share of each."""
    found = primal.forms[name].weights(primal.rows[rows])
    into.add(rows, found.columns, found.values * shares[:, None])
    if name in primal.bent:
        into.direct += shares @ primal.bent[name][rows]
