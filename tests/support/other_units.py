"""The same value in another unit of its quantity, by pint, which knows nothing of the table of clutchwork."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import pint

UREG: Any = pint.UnitRegistry()
# another word for each of SI
OTHERS = {"Pa": "bar", "N": "kN", "m": "mm", "s": "ms", "rad": "deg", "kg": "g", "W": "kW", "J": "kJ", "Hz": "kHz"}
ZERO = 273.15


@cache
def other(unit: str) -> str:
    """Another unit of the quantity: "kN mm/deg" for "N m/rad"."""
    if unit == "1":
        return "%"
    return re.sub(r"[A-Za-z]+", lambda word: OTHERS.get(word[0], word[0]), unit)


def of_pint(unit: str) -> str:
    """A unit as pint reads it: all that follows a slash divides, up to the end."""
    if unit == "%":
        return "percent"
    above, *below = unit.replace("(", "").replace(")", "").split("/")
    words = [re.sub(r"([A-Za-z])(\d)", r"\1**\2", part) for part in (above, *below)]
    return " / ".join(["*".join(words[0].split()), *(word for part in words[1:] for word in part.split())])


def quantity(value: float, unit: str) -> Any:
    """A number in SI as a quantity of pint in another unit; a temperature in degrees Celsius."""
    if unit == "K":
        return UREG.Quantity(value - ZERO, "degC")
    return UREG.Quantity(float(value), of_pint(unit)).to(of_pint(other(unit)))


def text(value: float, unit: str) -> str:
    """The same as a string."""
    name = "degC" if unit == "K" else other(unit)
    return f"{float(quantity(value, unit).magnitude)!r} {name}"


WAYS = {"text": text, "pint": quantity}
