"""One free parameter of a friction law as a number that is searched for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import exp, inf, log, nextafter
from typing import Any, TypeAlias

from clutchwork.base import dataclass
from clutchwork.declare.node import Law
from clutchwork.declare.schema import Spec
from clutchwork.fit.adjustable import kinetic
from clutchwork.fit.failure import FitError
from clutchwork.fit.ordinates import ABOVE, STATIC, ordinates, rival
from clutchwork.laws.bases.tables import Tabulated

Pair: TypeAlias = "tuple[float | None, float | None]"
Bounds: TypeAlias = "Mapping[str, Pair]"

# how far the search goes from a start value that must be above zero, as a factor
REACH = 1e6


@dataclass(frozen=True)
class Unknown:
    """A number of the law, or one ordinate of a table."""

    name: str  # "speed", "kinetic[2]" for the second point of a curve, "kinetic[2][3]" for a number of a row
    unit: str
    start: float
    bound: str  # in words
    lower: float  # ends of the search
    upper: float
    lowest: float  # ends of what the law or the user allows
    highest: float
    field: str
    point: int | None = None  # place in the table, row after row
    over: bool = False  # a static coefficient: its excess over the kinetic one is searched for

    @property
    def is_log(self) -> bool:
        """Whether its logarithm is searched for, because it must be above zero."""
        return self.lower > 0.0 and not self.over

    @property
    def scale(self) -> float:
        """What a change of its code is compared with: 1 for a logarithm, else the start value."""
        return 1.0 if self.is_log else abs(self.start) or 1.0

    def coded(self, value: float) -> float:
        """Value -> what is searched for."""
        return log(value) if self.is_log else value

    def decoded(self, code: float) -> float:
        """What is searched for -> value, within its bounds."""
        value = exp(code) if self.is_log else code
        return min(max(value, self.lower), self.upper)


def unknowns_of(law: Law, name: str, spec: Spec, unit: str, bounds: Bounds) -> list[Unknown]:
    """A parameter, or all ordinates of a table."""
    given = bounds.get(name, (None, None))
    if spec.what == "param":
        return [_made(name, spec, unit, float(getattr(law, name)), name, None, given)]
    named = enumerate(ordinates(law, name).items())
    return [_made(word, spec, unit, y, name, i, bounds.get(word, given)) for i, (word, y) in named]


def _made(name: str, spec: Spec, unit: str, start: float, field: str, point: int | None, given: Pair) -> Unknown:
    lowest, highest = _limits(name, spec, start, point, given)
    lower, upper = lowest, highest
    if lower > 0.0 and start > 0.0:
        lower, upper = max(lower, start / REACH), min(upper, start * REACH)
    if not lower <= start <= upper or lower >= upper:
        fault = f"of {name} are {lowest:g} to {highest:g}, its start value is {start:g}"
        raise FitError("bounds", fault, "start within the bounds")
    is_given = any(side is not None for side in given)
    words = f"{lowest:g} to {highest:g}" if is_given else spec.bound or (">= 0" if lower == 0.0 else "> 0")
    # static and kinetic coefficients move together, unless bounds hold the static one
    over = field == STATIC and not is_given
    return Unknown(name, unit, start, words, lower, upper, lowest, highest, field, point, over)


def _limits(name: str, spec: Spec, start: float, point: int | None, given: Pair) -> tuple[float, float]:
    """Bounds of the declaration, narrowed by given ones."""
    lowest, highest = spec.ends
    # an ordinate is a coefficient or a share: it keeps its sign
    if point is not None:
        lowest = max(lowest, nextafter(0.0, inf) if start > 0.0 else 0.0)
    lower, upper = given
    if lower is not None and upper is not None and lower > upper:
        raise FitError("bounds", f"of {name} are swapped: ({lower:g}, {upper:g})", f"give ({upper:g}, {lower:g})")
    return max(lowest, -inf if lower is None else float(lower)), min(highest, inf if upper is None else float(upper))


def below_static(law: Law, item: Unknown, free: list[str]) -> Unknown:
    """The same, or for a kinetic coefficient below a static one that is not free: with that as its upper end."""
    if isinstance(law, Tabulated):
        if item.field == STATIC or STATIC in free:
            return item
        upper = rival(law, item.point or 0) / ABOVE
        return replace(item, upper=min(item.upper, upper), highest=min(item.highest, upper))
    static: Any = law.static
    if item.point is not None or item.field == STATIC or STATIC in free or not static:
        return item
    if kinetic(replace(law, **{item.field: 0.9 * static})) != 0.9 * static:
        return item
    return replace(item, upper=min(item.upper, static), highest=min(item.highest, static))
