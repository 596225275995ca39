"""Actions and observations by name, with their ranges, as the spaces of Gymnasium."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from math import inf, isfinite
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass, quote
from clutchwork.base.arrays import Array
from clutchwork.declare.quantity import QuantityError, has_unit

InSI = Callable[[str, Any], Any]
RANGE = "give (low, high): finite, in the unit of it or with one that fits, the lower one first"


@dataclass(frozen=True)
class Ranges:
    """Names and, for each, what stands for -1 and for 1; without a range a value is given as it is."""

    names: tuple[str, ...]
    low: Array
    high: Array

    @property
    def bounded(self) -> NDArray[np.bool_]:
        """Which of them have a range."""
        return np.isfinite(self.low)

    def values(self, scaled: Any) -> dict[str, float]:
        """Values by name of numbers from -1 to 1."""
        share = (np.clip(np.asarray(scaled, dtype=float), -1.0, 1.0) + 1.0) / 2.0
        values = self.low + share * (self.high - self.low)
        return dict(zip(self.names, values.tolist(), strict=True))

    def scaled(self, values: Sequence[float]) -> NDArray[np.float32]:
        """Values as numbers from -1 to 1, those without a range as they are; what is out of its range is at its end."""
        given = np.asarray(values, dtype=float)
        with np.errstate(invalid="ignore"):
            share = np.clip(2.0 * (given - self.low) / (self.high - self.low) - 1.0, -1.0, 1.0)
        return np.where(self.bounded, share, given).astype(np.float32)

    def space(self, spaces: Any) -> Any:
        """The space of these numbers."""
        edge = np.where(self.bounded, 1.0, inf).astype(np.float32)
        return spaces.Box(-edge, edge, dtype=np.float32)


def ranges(what: str, given: object, needed: bool, in_si: InSI) -> tuple[Ranges, list[str]]:
    """Ranges of actions or observations, and what is wrong with them.

    Parameters: given, a mapping from names to (low, high), or names alone where a range is not needed; in_si, what a
    value of a name is in SI.
    """
    if isinstance(given, str):
        given = [given]
    if not isinstance(given, Mapping) and isinstance(given, Iterable) and not needed:
        given = dict.fromkeys(given)
    if not isinstance(given, Mapping) or not given:
        wanted = "a mapping from names to (low, high)" + ("" if needed else ", or names")
        return Ranges((), np.empty(0), np.empty(0)), [f"{what} is {quote(given)}: give {wanted}"]
    given = {name: plain(bounds, partial(in_si, name)) for name, bounds in given.items()}
    wrong = [
        f"{what} of {quote(name)} is {quote(bounds)}: {RANGE}"
        for name, bounds in given.items()
        if not (bounds is None and not needed) and not is_range(bounds)
    ]
    if wrong:
        return Ranges((), np.empty(0), np.empty(0)), wrong
    pairs = [(-inf, inf) if bounds is None else bounds for bounds in given.values()]
    return Ranges(tuple(map(str, given)), *np.array(pairs, dtype=float).T), []


def plain(bounds: Any, in_si: Callable[[Any], Any]) -> Any:
    """Bounds with their units put into SI; what cannot be read stays as it is."""
    if not isinstance(bounds, tuple | list) or not any(has_unit(one) for one in bounds):
        return bounds
    try:
        return type(bounds)(in_si(one) if has_unit(one) else one for one in bounds)
    except QuantityError:
        return bounds


def is_range(bounds: object) -> bool:
    """Whether it is two finite numbers, the lower one first."""
    if not isinstance(bounds, Sequence | np.ndarray) or isinstance(bounds, str) or len(bounds) != 2:
        return False
    if any(isinstance(one, bool) or not isinstance(one, Real) or not isfinite(float(one)) for one in bounds):
        return False
    return float(bounds[0]) < float(bounds[1])
