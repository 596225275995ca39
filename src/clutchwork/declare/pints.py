"""Quantities of pint, recognised without importing it: only those who pass one need that package."""

from __future__ import annotations

from typing import Any

# base units of pint, the place of each among the powers of `declare.units`, and its factor to SI
BASES = {
    "gram": (0, 1e-3),
    "meter": (1, 1.0),
    "second": (2, 1.0),
    "radian": (3, 1.0),
    "kelvin": (4, 1.0),
    "ampere": (5, 1.0),
}


class Foreign(Exception):  # noqa: N818, it is caught where a message is made of it
    """A quantity that cannot be converted to SI."""


def is_quantity(value: object) -> bool:
    """Whether a value is a quantity of pint."""
    kind = type(value)
    return hasattr(kind, "to_root_units") and hasattr(kind, "magnitude")


def is_list(quantity: Any) -> bool:
    """Whether a quantity holds an array or a list."""
    return getattr(quantity.magnitude, "ndim", 0) > 0


def powers_of(quantity: Any) -> tuple[float, ...]:
    """Powers of kg, m, s, rad, K and A; Foreign where it is made of something else."""
    powers = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    for name, power in _root(quantity).unit_items():
        if name not in BASES:
            raise Foreign
        powers[BASES[name][0]] += power
    return tuple(powers)


def magnitude(quantity: Any) -> Any:
    """The number in SI of a quantity, or the nested list of them."""
    one = type(quantity)(1.0, quantity.units)
    if has_other_zero(quantity):
        found = _root(quantity).magnitude
    else:
        factor = _root(one).magnitude
        for name, power in _root(one).unit_items():
            factor *= BASES[name][1] ** power
        found = quantity.magnitude * factor
    try:
        return found.tolist() if getattr(found, "ndim", 0) > 0 else float(found)
    except (TypeError, ValueError, OverflowError):
        raise Foreign from None


def is_difference(quantity: Any) -> bool:
    """Whether it is a temperature difference in a unit with an offset zero."""
    return "delta_" in str(quantity.units)


def has_other_zero(quantity: Any) -> bool:
    """Whether it is a temperature in a unit with an offset zero."""
    return bool(_root(type(quantity)(0.0, quantity.units)).magnitude != 0.0)


def _root(quantity: Any) -> Any:
    try:
        return quantity.to_root_units()
    except Exception:
        raise Foreign from None
