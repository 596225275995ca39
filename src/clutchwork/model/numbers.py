"""Checks of numbers, lists of numbers and curves, and the place of a value in messages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import inf, isfinite
from numbers import Real
from typing import Any, NamedTuple

from clutchwork.base import Problem, listed, quote
from clutchwork.base.quote import measured
from clutchwork.declare.quantity import PLAIN, QuantityError, has_unit, in_si, within
from clutchwork.declare.schema import Spec
from clutchwork.declare.units import Scale


class At(NamedTuple):
    """Place of a value: path of the element, name of the quantity, its SI unit, and what puts plain numbers into SI.

    `units` are further ones that the values of a signal may have.
    """

    path: str
    quantity: str
    unit: str = ""
    scale: Scale = PLAIN
    units: tuple[str, ...] = ()

    def problem(self, message: str, value: str = "", remedy: str = "") -> Problem:
        """A problem at this place."""
        return Problem(self.path, self.quantity, message, value, remedy)

    def inner(self, name: str, unit: str = "") -> At:
        """The place of a field of the value here."""
        return At(self.path, f"{self.quantity}.{name}" if self.quantity else name, unit)


def number_problems(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    """A finite number within its bounds."""
    if is_right(value, spec):
        return
    if has_unit(value):
        yield unit_problem(value, spec, at)
        return
    if isinstance(value, bool) or not isinstance(value, Real):
        yield at.problem(f"must be a number{within(at.unit)}", value=quote(value), remedy="write a plain number")
        return
    # the unit 1 of a bare number adds nothing
    unit = "" if at.unit == "1" else at.unit
    number, given = as_float(value), f"{quote(value) if isinstance(value, int) else as_float(value)} {unit}".strip()
    if not isfinite(number):
        yield at.problem("must be finite", value=given, remedy="give a finite number")
    elif not spec.allows(number):
        yield at.problem(f"must be {spec.bound} {unit}".rstrip(), value=given, remedy=instead(number, spec))
    elif spec.whole and number != int(number):
        yield at.problem("must be a whole number", value=given, remedy=_for("round it", spec))


def unit_problem(value: Any, spec: Spec, at: At) -> Problem:
    """Why a string or a quantity of pint is not one of this place."""
    try:
        in_si(value, at.unit, (*spec.units, *at.units), difference=spec.difference)
    except QuantityError as bad:
        return at.problem(bad.message, bad.value, bad.remedy)
    # put in after the object was made, such as into a list of points
    return at.problem(f"must be a number{within(at.unit)}", quote(value), "write a plain number")


def is_right(value: Any, spec: Spec) -> bool:
    """Whether a plain number needs no further look, as almost all do."""
    sound = type(value) is float and isfinite(value) and spec.allows(value) and not spec.whole
    return sound and not (spec.presses and value < 0.0)


def are_right(values: Sequence[Any], spec: Spec) -> bool:
    """Whether plain numbers need no further look: bounds are intervals, so the least and the most decide."""
    plain = bool(values) and {float}.issuperset(map(type, values)) and all(map(isfinite, values))
    return plain and is_right(min(values), spec) and is_right(max(values), spec)


def as_float(value: Real) -> float:
    """A number as a float, infinite where it is beyond all of them."""
    try:
        return float(value)
    except OverflowError:
        return inf


def instead(number: float, spec: Spec) -> str:
    """What to give in place of a number beyond a bound."""
    if spec.above == 0.0 and number <= 0.0:
        return _for("give a positive value", spec)
    if spec.at_least == 0.0 and number < 0.0:
        return _for("give zero or a positive value", spec)
    low = spec.above if spec.at_least is None else spec.at_least
    return _for("raise it" if low is not None and number <= low else "lower it", spec)


def _for(remedy: str, spec: Spec) -> str:
    return f"{remedy} ({spec.doc})" if spec.doc else remedy


def list_problems(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    """A list of numbers, or of equally long lists of them."""
    if value is None and spec.optional:
        return
    if has_unit(value) or getattr(value, "ndim", 1) == 0 or not hasattr(value, "__len__") or len(value) == 0:
        yield at.problem("must be a list of numbers", value=quote(value), remedy=f"write [x, y, ...]: {spec.doc}")
        return
    # numbers are in rows of their own
    rows = [row if _is_row(row) else [row] for row in value]
    wrong = next((n for n, row in enumerate(value) if not has_unit(row) and _is_row(row) is not spec.rows), None)
    if wrong is not None:
        place = At(at.path, f"{at.quantity}, number {wrong + 1}", at.unit)
        message, remedy = ("row of numbers", "[[x, y, ...], ...]") if spec.rows else ("number", "[x, y, ...]")
        yield place.problem(f"must be a {message}", value=quote(value[wrong]), remedy=f"write {remedy}: {spec.doc}")
        return
    if len({len(row) for row in rows}) > 1:
        lengths = listed(len(row) for row in rows)
        yield at.problem("has rows of different lengths", value=lengths, remedy="give every row as many numbers")
        return
    before = None
    for number, item in enumerate((item for row in rows for item in row), 1):
        place = At(at.path, f"{at.quantity}, number {number}", at.unit, units=at.units)
        found = list(number_problems(item, spec, place))
        if not found and spec.rising == "strictly" and before is not None and float(item) <= before:
            given, last = measured(float(item), at.unit, before), measured(before, at.unit, float(item))
            message = f"comes after {last}" if float(item) < before else "appears twice"
            remedy = "sort the numbers; each must be above the one before"
            found = [place.problem(message, value=given, remedy=remedy)]
        if found:
            yield from found
            return
        before = float(item)


def _is_row(item: Any) -> bool:
    return hasattr(item, "__len__") and not has_unit(item)


# what points are lists of
ROWS = frozenset((list, tuple))


def is_plain_curve(value: Any, spec: Spec) -> bool:
    """Whether points need no further look, as almost all do."""
    if type(value) not in ROWS or not value:
        return False
    least = -inf if spec.at_least is None else spec.at_least
    for point in value:
        if type(point) not in ROWS or len(point) != 2 or type(point[0]) is not float or type(point[1]) is not float:
            return False
        if not (isfinite(point[0]) and isfinite(point[1]) and least <= point[1]):
            return False
    for (x, y), (x_next, y_next) in pairwise(value):
        width = x_next - x
        if width < 0.0 or (width == 0.0 and spec.rising == "strictly"):
            return False
        if width > 0.0 and not isfinite((y_next - y) / width):
            return False
    return True


def curve_problems(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    """Points with increasing abscissae, or a number where that is allowed."""
    if is_plain_curve(value, spec):
        return
    if spec.constant and (isinstance(value, Real) or (has_unit(value) and getattr(value, "ndim", 0) == 0)):
        yield from number_problems(value, spec, at)
        return
    if has_unit(value) or getattr(value, "ndim", 1) == 0 or not hasattr(value, "__len__") or len(value) == 0:
        yield at.problem("must be a list of points", value=quote(value), remedy=f"write [[x, y], ...]: {spec.doc}")
        return
    before = None
    plain = Spec("param", spec.unit_x, "", units=spec.units_x)
    bounded = Spec("param", at.unit, "", at_least=spec.at_least, units=(*spec.units, *at.units))
    for number, point in enumerate(value, 1):
        place = At(at.path, f"{at.quantity}, point {number}", at.unit, units=at.units)
        # one mistake is enough: those behind it often follow from it
        found = list(_point(point, (plain, bounded), place)) or list(_order(before, point, spec, place))
        if found:
            yield from found
            return
        before = point


def _point(point: Any, specs: tuple[Spec, Spec], at: At) -> Iterator[Problem]:
    """A pair of finite numbers."""
    if has_unit(point) or not hasattr(point, "__len__") or len(point) != 2:
        yield at.problem("must be a pair of numbers", value=quote(point), remedy="write [x, y]")
        return
    for number, part in zip(point, specs, strict=True):
        yield from number_problems(number, part, At(at.path, at.quantity, part.unit))


def _order(before: Any, point: Any, spec: Spec, at: At) -> Iterator[Problem]:
    """Abscissae that increase, by more than round-off."""
    if before is None:
        return
    (x, y), (x_next, y_next) = ((float(a), float(b)) for a, b in (before, point))
    given, last = measured(x_next, spec.unit_x, x), measured(x, spec.unit_x, x_next)
    if x_next < x or (x_next == x and spec.rising == "strictly"):
        message = f"comes after {last}" if x_next < x else "appears twice"
        rule = "x must increase" if spec.rising == "strictly" else "x must not fall; two points at one x are a jump"
        yield at.problem(message, value=given, remedy=f"sort the points; {rule}")
    elif x_next > x and not isfinite((y_next - y) / (x_next - x)):
        yield at.problem(f"is too close to {last}", value=given, remedy="remove one of the points")
