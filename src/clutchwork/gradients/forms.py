"""How signals change with the numbers of a row: the derivatives of their forms."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.results.forms import LOCKED, Affine, Dot, Form, Mode, Power, Powers, RowEntry, Slip, Total

Array = NDArray[np.float64]


class Weights(NamedTuple):
    """Derivatives of a signal by numbers of its rows: places in a row, and a line of derivatives for each row."""

    columns: NDArray[np.intp]
    values: Array


def weights(form: Form, rows: Array) -> Weights:
    """The derivatives of a signal by the numbers of each row. docs/theory/gradients.md (8)."""
    match form:
        case RowEntry(index):
            return _equal([index], [1.0], rows)
        case Affine(index, scale):
            return _equal([index], [scale], rows)
        case Total(indices, negative):
            return _equal(indices, [-1.0 if negative else 1.0] * len(indices), rows)
        case Dot(used, factors):
            return _equal(used, factors, rows)
        case Slip(rate, mode):
            found = weights(rate, rows)
            return Weights(found.columns, found.values * (rows[:, mode] != LOCKED)[:, None])
        case Power(torque, rate):
            one, other = weights(torque, rows), weights(rate, rows)
            parts = [one.values * rate(rows)[:, None], other.values * torque(rows)[:, None]]
            return Weights(np.concatenate([one.columns, other.columns]), np.concatenate(parts, axis=1))
        case Powers(powers):
            found_of = [weights(power, rows) for power in powers]
            columns = np.concatenate([one.columns for one in found_of])
            return Weights(columns, np.concatenate([one.values for one in found_of], axis=1))
        case Mode():
            return Weights(np.zeros(0, dtype=np.intp), np.zeros((len(rows), 0)))


def _equal(columns: object, factors: object, rows: Array) -> Weights:
    """The same derivatives in all rows."""
    line = np.asarray(factors, dtype=float)
    return Weights(np.asarray(columns, dtype=np.intp), np.broadcast_to(line, (len(rows), len(line))))
