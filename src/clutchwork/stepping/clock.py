"""Times of steps: given in seconds, and added up without drift."""

from __future__ import annotations

from math import isfinite
from numbers import Real

from clutchwork.base.errors import UseError
from clutchwork.base.quote import quote
from clutchwork.declare.quantity import QuantityError, has_unit, in_si

# two instants that are closer are one, as a share of them
ROUND_OFF = 1e-12


def after(time: float, step: float) -> float:
    """The end of a step [s]: a multiple of it where it is one up to round-off, as a decimal, which knots are."""
    end = time + step
    if step > 0.0:
        whole = float(f"{round(end / step) * step:.15g}")
        end = whole if same(whole, end) else end
    return end


def same(one: float, other: float) -> bool:
    """Whether two times are one within round-off."""
    return abs(one - other) <= ROUND_OFF * other


def in_seconds(call: str, name: str, value: object) -> float:
    """A finite time [s]; UseError for anything else."""
    if type(value) is float and isfinite(value):
        return value
    given = _converted(value) if has_unit(value) else value
    if isinstance(given, bool) or not isinstance(given, Real) or not isfinite(float(given)):
        raise UseError(call, [f"{name} is {quote(value)}: give a number in s"])
    return float(given)


def _converted(value: object) -> object:
    try:
        return in_si(value, "s")
    except QuantityError:
        return None
