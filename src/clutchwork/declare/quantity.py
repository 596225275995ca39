"""Numbers at the border: plain, as a string with a unit, as a quantity of pint, or as a table {value, unit}, into SI.

Python and model files read values here alike. `declare.given` reads whole fields.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from clutchwork.base import ClutchworkError, advised, near, quote
from clutchwork.base.quote import shortened
from clutchwork.declare import pints, units
from clutchwork.declare.unit_table import example_of, fitting
from clutchwork.declare.unit_table import unit_table as unit_table
from clutchwork.declare.units import KELVIN, Scale

# numbers as they are
PLAIN = Scale(1.0)


def within(unit: str) -> str:
    """` in [N m]`; nothing for a number without a unit."""
    return "" if unit in ("", "1") else f" in [{unit}]"


class QuantityError(ClutchworkError, ValueError):
    """A value that is not a quantity of the expected unit."""

    def __init__(self, message: str, value: str, remedy: str) -> None:
        self.message, self.value, self.remedy = message, value, remedy
        super().__init__(f"{value}: {advised(message, remedy)}")


def has_unit(value: object) -> bool:
    """Whether a value may be a quantity with a unit: a string, or a quantity of pint."""
    return isinstance(value, str) or pints.is_quantity(value)


def in_si(
    value: Any,
    unit: str,
    others: tuple[str, ...] = (),
    factor: float = 1.0,
    *,
    whole: bool = False,
    difference: bool = False,
    zero: float = 0.0,
) -> Any:
    """The number in SI. Anything but a string, a quantity or a table is returned for the checks that follow.

    Parameters: unit, the SI unit that is wanted; others, further ones that the quantity may have; factor and zero, to
    SI from a plain number; whole, whether an integer stays one; difference, whether it is one of temperatures.
    """
    if isinstance(value, Mapping):
        unknown = [key for key in value if key not in ("value", "unit")]
        if unknown or "value" not in value:
            raise QuantityError(
                "must be a number", quote(dict(value)), 'write a number, or {value = 1.0, unit = "..."}'
            )
        if "unit" in value:
            factor, zero = scale_to_si(value["unit"], unit, others, dict(value), difference=difference)
        if isinstance(value["value"], Mapping):
            raise QuantityError("holds a table", quote(value), 'write {value = 1.0, unit = "..."}')
        return in_si(value["value"], unit, others, factor, difference=difference, zero=zero)
    if isinstance(value, str):
        return _from_text(value, unit, others, difference)
    if pints.is_quantity(value):
        return from_pint(value, unit, others, difference=difference)
    return value if whole else times(value, Scale(factor, zero))


def seconds(text: str) -> float:
    """A time [s] as the command line gives it: "0.4" or "400 ms"; QuantityError where it is none."""
    try:
        return float(text)
    except ValueError:
        return float(in_si(text, "s"))


def _from_text(value: str, unit: str, others: tuple[str, ...], difference: bool) -> float:
    parts = units.split(value)
    if parts is None:
        remedy = f"write a number{within(unit)}, or a string such as {example_of(unit)!r}"
        if units.has_comma(value):
            remedy = f"write a decimal point: {value.replace(',', '.').strip()!r}"
        raise QuantityError("is not a number", quote(value), remedy)
    if not parts[1]:
        example = "" if unit == "1" else f" or add one, such as '{parts[0]:g} {unit}'"
        raise QuantityError("has no unit", quote(value), f"remove the quotes{example}")
    found = scale_to_si(parts[1], unit, others, value, difference=difference)
    return found.si(parts[0])


def from_pint(quantity: Any, unit: str, others: tuple[str, ...] = (), *, difference: bool = False) -> Any:
    """The number in SI of a quantity of pint, or the nested list of those of an array."""
    value, wanted = shortened(str(quantity), 80), _wanted(unit, others)
    if not pints.is_list(quantity) and isinstance(quantity.magnitude, bool | str):
        raise QuantityError("is not a number", value, f"give it in {wanted}")
    try:
        powers, other = pints.powers_of(quantity), pints.has_other_zero(quantity)
        fits = powers in {units.powers_of(name) for name in (unit, *others)}
        if fits and powers == KELVIN and difference and other:
            raise _refused(value, "degC", wanted, difference)
        if fits and powers == KELVIN and not difference and pints.is_difference(quantity):
            raise QuantityError("is a difference of temperatures", value, "give the temperature itself, in degC or K")
        if fits:
            return pints.magnitude(quantity)
    except pints.Foreign:
        pass
    example = "" if unit == "1" else f", such as {example_of(unit)!r}"
    raise QuantityError("has a unit that does not fit", value, f"give it in {wanted}{example}")


def scale_to_si(
    given: Any, unit: str, others: tuple[str, ...] = (), whole: object = None, *, difference: bool = False
) -> Scale:
    """Conversion from a given unit to the expected SI unit; QuantityError, which shows the value, if there is none.

    Parameters: others, further units that may be wanted; whole, the value as it was given; difference, whether numbers
    are differences, so that a unit with another zero is refused.
    """
    value, wanted = quote(given if whole is None else whole), _wanted(unit, others)
    if not isinstance(given, str):
        raise QuantityError("must be a unit", value, f"write it as a string, such as {unit!r}")
    try:
        found = units.scale(given, (unit, *others), difference=difference)
    except ValueError as error:
        word = str(error)
        if units.other_zero(word):
            raise _refused(value, word, wanted, difference and units.powers_of(unit) == KELVIN) from None
        meant = _meant(word, (unit, *others))
        raise QuantityError(f"has the unknown unit {quote(word)}{meant}", value, f"give it in {wanted}") from None
    if found is None:
        example = "" if unit == "1" else f", such as {example_of(unit)!r}"
        raise QuantityError("has a unit that does not fit", value, f"give it in {wanted}{example}")
    return found


def _meant(word: str, wanted: tuple[str, ...]) -> str:
    """`; did you mean ...?` where an unknown unit is close to a known one, those that fit first."""
    # a product without its space, or with a sign for its power
    glued = [name for name in wanted if name.replace(" ", "") == word.replace("^", "")]
    if glued:
        return f"; did you mean {glued[0]!r}?"
    every = [*units.known(), "degC", "degF"]
    fits = [name for unit in wanted for name in fitting(unit) if name in every]
    # MPa for mpa: letters of another size
    same = [name for name in fits if name.casefold() == word.casefold()]
    return f"; did you mean {same[0]!r}?" if same else near(word, fits) or near(word, every)


def _wanted(unit: str, others: tuple[str, ...]) -> str:
    return " or ".join(f"[{name}]" for name in (unit, *others))


def _refused(value: str, word: str, wanted: str, difference: bool) -> QuantityError:
    """A temperature in degrees where a difference or another quantity is expected."""
    if difference:
        remedy = "give it in [K]; a difference of 1 degC, or of 1.8 degF, is 1 K"
        return QuantityError(f"is in {word}, which has another zero, and a difference has none", value, remedy)
    remedy = f"give it in {wanted}; per kelvin, a degree Celsius is 1 K"
    return QuantityError(
        f"is in {word}, which has another zero", value, remedy if "K" in wanted else f"give it in {wanted}"
    )


def factor_to_si(given: Any, unit: str, others: tuple[str, ...] = (), whole: object = None) -> float:
    """Factor from a given unit to the wanted SI unit; QuantityError, which shows the value, where they do not fit."""
    return scale_to_si(given, unit, others, whole, difference=True).factor


def times(value: Any, scale: Scale) -> Any:
    """A number in SI; booleans and non-numbers stay as they are."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    try:
        return scale.si(value)
    except OverflowError:
        # an integer beyond all floats, which the checks that follow refuse
        return value
