"""Values with units become numbers in SI where an object is made: in Python as its fields are given, in files as read.

What cannot be read stays as it was given; the checks report it with all other mistakes. decisions/0026
"""

from __future__ import annotations

from dataclasses import fields, replace
from functools import cache
from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple

from clutchwork.base.classes import PLAIN as PLAIN_TYPES
from clutchwork.base.frozen import Frozen, frozen
from clutchwork.declare import pints
from clutchwork.declare.quantity import PLAIN, QuantityError, from_pint, has_unit, in_si, times

if TYPE_CHECKING:
    from collections.abc import Mapping

    from clutchwork.declare.schema import Spec
    from clutchwork.declare.units import Scale

NUMBERS = frozenset((float, int, bool))
# sorts of fields that hold numbers
READ = ("param", "option", "signal", "alternative", "curve", "numbers")
# and those that hold tables
TABLES = ("named", "elements", "data", "formula")


class TargetUnit(NamedTuple):
    """Unit that a number is converted to: the SI unit, others that are accepted, whether it is a difference."""

    unit: str
    others: tuple[str, ...] = ()
    difference: bool = False
    scale: Scale = PLAIN  # of plain numbers, in a model file

    def number(self, value: Any) -> Any:
        """Converts to SI; returns anything unconvertible unchanged."""
        if not has_unit(value):
            return value if self.scale is PLAIN else times(value, self.scale)
        if self.unit == "*" or is_array(value):
            return value
        try:
            return in_si(value, self.unit, self.others, difference=self.difference)
        except QuantityError:
            return value


def field_in_si(value: Any, spec: Spec, driven: TargetUnit | None = None) -> Any:
    """The value of a field in SI, the same object where nothing of it has a unit.

    Parameters: driven, for a field of a signal in the unit of what it drives: that unit.
    """
    star = spec.unit == "*"
    wanted = TargetUnit(spec.unit, spec.units, spec.difference)
    if star and driven is not None:
        wanted = driven._replace(difference=spec.difference)
    if spec.what == "curve":
        return points_in_si(value, TargetUnit(spec.unit_x, spec.units_x), wanted, constant=spec.constant)
    if spec.what == "numbers":
        return numbers_in_si(value, wanted)
    return wanted.number(value)


def points_in_si(value: Any, x: TargetUnit, y: TargetUnit, *, constant: bool = False) -> Any:
    """Pairs with both parts in SI, or with `constant` one number; anything else stays for the checks."""
    if has_unit(value) or isinstance(value, int | float):
        return y.number(value) if constant else value
    if not _is_list(value) or (x.scale is PLAIN and y.scale is PLAIN and _all_plain(value)):
        return value
    made = [
        (x.number(pair[0]), y.number(pair[1])) if isinstance(pair, list | tuple) and len(pair) == 2 else pair
        for pair in value
    ]
    same = all(new is old or (new[0] is old[0] and new[1] is old[1]) for new, old in zip(made, value, strict=True))
    return value if same else tuple(made)


def numbers_in_si(value: Any, wanted: TargetUnit) -> Any:
    """Numbers, or rows of them, in SI; an array of pint too."""
    if pints.is_quantity(value):
        try:
            found = from_pint(value, wanted.unit, wanted.others) if pints.is_list(value) else value
        except QuantityError:
            return value
        return in_tuples(found)
    if not _is_list(value) or (wanted.scale is PLAIN and NUMBERS.issuperset(map(type, value))):
        return value
    made = [numbers_in_si(item, wanted) if _is_list(item) or is_array(item) else wanted.number(item) for item in value]
    return value if all(new is old for new, old in zip(made, value, strict=True)) else tuple(made)


def _is_list(value: Any) -> bool:
    return isinstance(value, list | tuple) or getattr(getattr(value, "dtype", None), "kind", "") == "O"


def is_array(value: Any) -> bool:
    """Whether a value is an array of pint."""
    return pints.is_quantity(value) and pints.is_list(value)


def _all_plain(points: Any) -> bool:
    try:
        return NUMBERS.issuperset(map(type, chain.from_iterable(points)))
    except TypeError:
        return False


def in_tuples(value: Any) -> Any:
    """Lists as tuples, at every level."""
    return tuple(map(in_tuples, value)) if isinstance(value, list) else value


# units of what turns, and of the same on a line
PARTNERS = {
    "rad/s": "m/s",
    "rad": "m",
    "N m": "N",
    "N m/rad": "N/m",
    "N m s/rad": "N s/m",
    "m3": "m2",
    # of a law, per slip and deflection
    "s/rad": "s/m",
    "1/rad": "1/m",
    # of a gain, per force
    "m": "1",
}


def settled(name: str, spec: Spec, cls: Any, values: Mapping[str, Any]) -> Spec:
    """The spec of a field with only the units that fit its nodes, and for a gain the signal it multiplies.

    Parameters: values of the fields that are given, nodes at its ports.
    """
    if not spec.units:
        return spec
    units = (spec.unit, *spec.units)
    gains = _gains(cls) if name == "gain" else {}
    found = {gains[other] for other, value in values.items() if value is not None and other in gains}
    units = next(iter(found)) if len(found) == 1 else units
    domains = {value.domain.value for value in values.values() if hasattr(value, "domain") and not value.fixed}
    if len(domains) == 1:
        turns = "rotation" in domains
        wrong = {
            unit for pair in PARTNERS.items() if pair[0] in units and pair[1] in units for unit in pair[turns:][:1]
        }
        units = tuple(unit for unit in units if unit not in wrong)
    return spec if units == (spec.unit, *spec.units) else _in_units(spec, units)


@cache
def _gains(cls: Any) -> Mapping[str, tuple[str, ...]]:
    """Units of the gain by the signal that it multiplies."""
    return {name: spec.gain for name, spec in _specs(cls) if spec.gain}


@cache
def _in_units(spec: Spec, units: tuple[str, ...]) -> Spec:
    return replace(spec, unit=units[0], units=units[1:])


@cache
def _specs(cls: Any) -> tuple[tuple[str, Spec], ...]:
    found = [(item.name, item.metadata["spec"]) for item in fields(cls) if "spec" in item.metadata]
    return tuple((name, spec) for name, spec in found if spec.what in READ and not (spec.flag or spec.choices))


def accept(thing: Any) -> None:
    """Convert the values of a new declared object to SI, as far as they can be read."""
    cls: Any = type(thing)
    values = vars(thing)
    for name, spec in _specs(cls):
        value = values[name]
        if type(value) in PLAIN_TYPES or (spec.what == "curve" and _all_plain(value)):
            continue
        if spec.what in ("signal", "alternative") and not has_unit(value):
            fits = settled(name, spec, cls, values)
            new = driving(value, fits.unit, fits.units)
        else:
            new = field_in_si(value, settled(name, spec, cls, values))
            if spec.unit == "*" and _in_units_of_its_own(new, spec):
                values["has_units"] = True
        if new is not value:
            values[name] = new
    for name, spec in _tables(cls):
        values[name] = table_in_si(values[name], spec)


@cache
def _tables(cls: Any) -> tuple[tuple[str, Spec], ...]:
    found = [(item.name, item.metadata["spec"]) for item in fields(cls) if "spec" in item.metadata]
    return tuple((name, spec) for name, spec in found if spec.what in TABLES)


def table_in_si(value: Any, spec: Spec) -> Any:
    """A frozen table with its numbers in SI; a path as a string, anything else unchanged."""
    if spec.what == "data" and hasattr(value, "__fspath__"):
        return value.__fspath__()
    if spec.what != "named" or not hasattr(value, "items"):
        return frozen(value)
    wanted = TargetUnit(spec.unit, spec.units, spec.difference)
    return Frozen({name: wanted.number(number) for name, number in value.items()})


def _in_units_of_its_own(value: Any, spec: Spec) -> bool:
    """Whether values have units, whose meaning depends on what the signal drives."""
    if spec.what != "curve":
        return has_unit(value)
    pairs = value if _is_list(value) else ()
    return any(isinstance(pair, list | tuple) and len(pair) == 2 and has_unit(pair[1]) for pair in pairs)


def driving(signal: Any, unit: str, others: tuple[str, ...] = ()) -> Any:
    """A signal whose values with units are converted to that of what it drives; anything else unchanged."""
    if not getattr(signal, "has_units", False):
        return signal
    driven = TargetUnit(unit, others)
    cls: Any = type(signal)
    values = vars(signal)
    new = {name: field_in_si(values[name], spec, driven) for name, spec in _specs(cls) if spec.unit == "*"}
    changed = {name: value for name, value in new.items() if value is not values[name]}
    return replace(signal, **changed) if changed else signal
