"""Numbers at the border: plain, as a string with a unit, or as a table {value, unit}, turned into SI."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from clutchwork.base.errors import ClutchworkError, advised, near
from clutchwork.base.shown import shown
from clutchwork.declare import units

if TYPE_CHECKING:
    from clutchwork.declare.schema import Spec


# units of temperature that no factor leads to kelvin from
OTHER_ZERO = ("degC", "C", "degF", "F")


def within(unit: str) -> str:
    """` in [N m]`; nothing for a number without a unit."""
    return "" if unit in ("", "1") else f" in [{unit}]"


class QuantityError(ClutchworkError, ValueError):
    """A value that is not a quantity of the wanted unit."""

    def __init__(self, message: str, value: str, remedy: str) -> None:
        self.message, self.value, self.remedy = message, value, remedy
        super().__init__(f"{value}: {advised(message, remedy)}")


def in_si(value: Any, unit: str, others: tuple[str, ...] = (), factor: float = 1.0, *, whole: bool = False) -> Any:
    """The number in SI. What is neither a string nor a table is returned for the checks that follow.

    Parameters: unit, the SI unit that is wanted; others, further ones that the quantity may have; factor, to SI from
    a plain number; whole, whether an integer stays one.
    """
    if isinstance(value, Mapping):
        unknown = [key for key in value if key not in ("value", "unit")]
        if unknown or "value" not in value:
            raise QuantityError(
                "must be a number", shown(dict(value)), 'write a number, or {value = 1.0, unit = "..."}'
            )
        if "unit" in value:
            factor = factor_to_si(value["unit"], unit, others, dict(value))
        if isinstance(value["value"], Mapping):
            raise QuantityError("holds a table", shown(value), 'write {value = 1.0, unit = "..."}')
        return in_si(value["value"], unit, others, factor)
    if isinstance(value, str):
        parts = units.split(value)
        if parts is None:
            raise QuantityError(
                "is not a number", shown(value), f"write a number{within(unit)}, or a string such as '1.5 {unit}'"
            )
        if not parts[1]:
            example = "" if unit == "1" else f" or add one, such as '{parts[0]:g} {unit}'"
            raise QuantityError("has no unit", shown(value), f"remove the quotes{example}")
        return parts[0] * factor_to_si(parts[1], unit, others, value) + 0.0
    return value if whole else _times(value, factor)


def factor_to_si(given: Any, unit: str, others: tuple[str, ...] = (), whole: object = None) -> float:
    """Factor from a given unit to the wanted SI unit; QuantityError, which shows the value, where they do not fit."""
    value = shown(given if whole is None else whole)
    wanted = " or ".join(f"[{name}]" for name in (unit, *others))
    if not isinstance(given, str):
        raise QuantityError("must be a unit", value, f"write it as a string, such as {unit!r}")
    try:
        factor, powers = units.parse(given)
    except ValueError as error:
        word = str(error)
        remedy = f"give it in {wanted}"
        if word in OTHER_ZERO:
            remedy = f"{remedy}; temperatures are in K; 0 degC is 273.15 K"
            raise QuantityError(f"is in {word}, which has another zero", value, remedy) from None
        raise QuantityError(f"has the unknown unit {shown(word)}{near(word, units.known())}", value, remedy) from None
    if all(powers != units.parse(name).powers for name in (unit, *others)):
        raise QuantityError("has a unit that does not fit", value, f"give it in {wanted}")
    return factor


def curve_in_si(value: Any, spec: Spec, unit: str, factor: float = 1.0) -> Any:
    """Points in SI from a list of pairs, whose ordinates times `factor` are SI, or a table {points, unit_x, unit}."""
    if spec.constant and (isinstance(value, str | float | int) or (isinstance(value, Mapping) and "value" in value)):
        return in_si(value, unit, spec.units, factor)
    if not isinstance(value, Mapping):
        return _scaled(value, 1.0, factor)
    unknown = [key for key in value if key not in ("points", "unit_x", "unit")]
    if unknown or "points" not in value:
        raise QuantityError(
            "must be a list of points", shown(dict(value)), "write {points = [[x, y], ...], unit_x, unit}"
        )
    x = factor_to_si(value["unit_x"], spec.unit_x, spec.units_x) if "unit_x" in value else 1.0
    y = factor_to_si(value["unit"], unit, spec.units) if "unit" in value else factor
    return _scaled(value["points"], x, y)


def numbers_in_si(value: Any, spec: Spec, unit: str) -> Any:
    """Numbers, or rows of them, in SI from a list, or from a table {values, unit}."""
    factor = 1.0
    if isinstance(value, Mapping):
        unknown = [key for key in value if key not in ("values", "unit")]
        if unknown or "values" not in value:
            raise QuantityError("must be a list of numbers", shown(dict(value)), "write {values = [x, y, ...], unit}")
        factor = factor_to_si(value["unit"], unit, spec.units) if "unit" in value else 1.0
        value = value["values"]
    if not isinstance(value, list):
        return value
    return [[_times(x, factor) for x in row] if isinstance(row, list) else _times(row, factor) for row in value]


def _scaled(value: Any, x: float, y: float) -> Any:
    """Pairs times factors; what is not a list of pairs of numbers is returned for the checks that follow."""
    if not isinstance(value, list) or not all(isinstance(point, list) and len(point) == 2 for point in value):
        return value
    return [(_times(a, x), _times(b, y)) for a, b in value]


def _times(value: Any, factor: float) -> Any:
    """A number times a factor; true, false and what is not a number stay."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    try:
        # minus zero becomes zero, so that what is written reads back to the same bits
        return value * factor + 0.0
    except OverflowError:
        # an integer beyond all floats, which the checks that follow refuse
        return value
