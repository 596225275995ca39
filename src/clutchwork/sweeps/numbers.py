"""Numbers that calls are given, with units where they have some."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, isfinite
from numbers import Real
from typing import Any

from clutchwork.declare.quantity import QuantityError, has_unit, in_si


def number(given: Any, unit: str) -> float | None:
    """A finite number in SI; None where it is something else."""
    try:
        value = in_si(given, unit) if has_unit(given) else given
    except QuantityError:
        return None
    if not isinstance(value, Real) or isinstance(value, bool) or not isfinite(float(value)):
        return None
    return float(value)


def pair(given: Any, unit: str) -> tuple[float, float] | None:
    """Two numbers in SI, the lower one first; None where it is something else."""
    if not isinstance(given, Sequence) or isinstance(given, str) or len(given) != 2:
        return None
    low, high = number(given[0], unit), number(given[1], unit)
    return (low, high) if low is not None and high is not None and low < high else None


def bounds(lower: Any, upper: Any, unit: str) -> tuple[float, float] | None:
    """A lower and an upper bound, infinite where there is none; None where one does not fit."""
    low = -inf if lower is None else number(lower, unit)
    high = inf if upper is None else number(upper, unit)
    return (low, high) if low is not None and high is not None and low <= high else None
