"""Derivatives of signals from those of the output row: docs/theory/linearisation.md (11)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.results.forms import LOCKED, Affine, Dot, Form, Power, Powers, RowEntry, Slip, Total

Array = NDArray[np.float64]


def columns_of(form: Any) -> tuple[int, ...]:
    """Numbers of the row that a signal follows from."""
    if isinstance(form, RowEntry | Affine):
        return (form.index,)
    if isinstance(form, Total):
        return form.indices
    if isinstance(form, Dot):
        return tuple(form.used.tolist())
    if isinstance(form, Slip):
        return columns_of(form.rate)
    if isinstance(form, Power):
        return columns_of(form.torque) + columns_of(form.rate)
    if isinstance(form, Powers):
        return tuple(column for part in form.parts for column in columns_of(part))
    return ()


def derivative(form: Form, row: Array, change: Array) -> Array:
    """Derivative of a signal at a row, from those of the numbers of the row, one line each."""
    if isinstance(form, RowEntry):
        line: Array = change[form.index]
        return line
    if isinstance(form, Affine):
        scaled: Array = form.scale * change[form.index]
        return scaled
    if isinstance(form, Total):
        total: Array = change[list(form.indices)].sum(axis=0)
        return -total if form.negative else total
    if isinstance(form, Dot):
        product: Array = form.factors @ change[form.used]
        return product
    if isinstance(form, Slip):
        still = row[form.mode] == LOCKED
        return np.zeros(change.shape[1]) if still else derivative(form.rate, row, change)
    if isinstance(form, Power):
        torque, rate = (float(part(row[None, :])[0]) for part in (form.torque, form.rate))
        return rate * derivative(form.torque, row, change) + torque * derivative(form.rate, row, change)
    if isinstance(form, Powers):
        powers: Array = np.sum([derivative(part, row, change) for part in form.parts], axis=0)
        return powers
    raise TypeError(f"{form} has no derivative")
