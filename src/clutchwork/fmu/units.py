"""Units of the variables of an FMU: powers of base units, and units for display."""

from __future__ import annotations

from collections.abc import Iterable
from math import pi
from typing import NamedTuple
from xml.etree.ElementTree import Element, SubElement

from clutchwork.declare.units import powers_of

# in the order of the powers of declare.units
BASES = ("kg", "m", "s", "rad", "K", "A")


class Display(NamedTuple):
    """A unit for display: what is shown is factor times the value, plus an offset."""

    name: str
    factor: float
    offset: float = 0.0


DISPLAY = {
    "rad/s": Display("rpm", 30.0 / pi),
    "rad": Display("deg", 180.0 / pi),
    "Pa": Display("bar", 1e-5),
    "K": Display("degC", 1.0, -273.15),
}


def add_units(root: Element, units: Iterable[str]) -> None:
    """Add the definitions of units."""
    definitions = SubElement(root, "UnitDefinitions")
    for unit in sorted(set(units)):
        made = SubElement(definitions, "Unit", name=unit)
        powers = {base: str(power) for base, power in zip(BASES, powers_of(unit), strict=True) if power}
        SubElement(made, "BaseUnit", powers)
        if unit in DISPLAY:
            shown = DISPLAY[unit]
            offset = {"offset": repr(shown.offset)} if shown.offset else {}
            SubElement(made, "DisplayUnit", {"name": shown.name, "factor": repr(shown.factor)} | offset)


def unit_attributes(unit: str) -> dict[str, str]:
    """What a variable says of its unit."""
    shown = {"displayUnit": DISPLAY[unit].name} if unit in DISPLAY else {}
    return {"unit": unit, **shown}
