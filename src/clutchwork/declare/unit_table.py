"""The units that values may be given in, as a table for people and programs."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

from clutchwork.declare.unit_words import OTHER_ZERO, QUANTITIES, TABLE, UnitGroup
from clutchwork.declare.units import Scale, powers_of, scale

# second words of units that are listed already
HIDDEN = ("l", "ml", "C", "F")
# what is often made of words
MADE_OF = (
    *("N m", "lbf ft", "1/min", "U/min", "deg/s", "rad/s", "rad/s2", "1/s", "m/s", "km/h", "m/s2", "m2", "cm2", "m3"),
    *("cm3", "L/min", "kg m2", "kg cm2", "g cm2", "N m/rad", "N m/deg", "N m s/rad", "Nm/rpm", "N/m", "N s/m", "J/K"),
    *("J/(kg K)", "W/K", "W/(m K)", "W/(m2 K)", "kg/s", "kg/m3"),
)


class UnitRow(NamedTuple):
    """A unit: `number * factor + offset` is in `si`, the unit of SI of its quantity."""

    name: str
    quantity: str
    si: str
    factor: float
    offset: float
    examples: tuple[str, ...]


@cache
def unit_table() -> tuple[UnitRow, ...]:
    """All words for units and their usual combinations, by quantity.

    Words are combined with blanks, powers and one slash: "kg cm2", "N m s/rad", "kJ/(kg K)".
    """
    found = []
    for quantity in QUANTITIES:
        names = [name for name in (*TABLE, *MADE_OF) if name not in HIDDEN and _measures(name, quantity)]
        names += [name for name in OTHER_ZERO if name not in HIDDEN and quantity.unit == "K"]
        for name in names:
            made = scale(name, (quantity.unit,)) or Scale(1.0)
            found.append(UnitRow(name, quantity.name, quantity.unit, made.factor, made.zero, quantity.examples))
    return tuple(found)


def fitting(unit: str) -> list[str]:
    """Units that convert to a given SI unit."""
    exact = [row.name for row in unit_table() if row.si == unit]
    return exact or [row.name for row in unit_table() if powers_of(row.si) == powers_of(unit)]


def _measures(name: str, quantity: UnitGroup) -> bool:
    """Whether a word is one of a quantity; that of torque is one of work by its powers alone."""
    turns = ("1/min",)
    if name in turns:
        return quantity.unit == "rad/s"
    torque = name in ("N m", "Nm", "mNm", "kNm", "lbf ft")
    # a force per speed is no mass flow, though it has the powers of one, and the other way round
    if name != quantity.unit and name in (other.unit for other in QUANTITIES):
        return False
    if powers_of(name) == powers_of("J"):
        return quantity.unit == ("N m" if torque else "J")
    return powers_of(name) == powers_of(quantity.unit)


def example_of(unit: str) -> str:
    """A value as a string in a unit compatible with an SI unit, such as "2 bar" for Pa."""
    exact = next((quantity for quantity in QUANTITIES if quantity.unit == unit), None)
    found = exact or next((one for one in QUANTITIES if powers_of(one.unit) == powers_of(unit)), None)
    return found.examples[0] if found else f"1.5 {unit}"
