"""Units at the border: text such as "0.2 kg m2" or "30 bar" becomes a number in SI.

Nothing behind the border knows any other unit than SI.
"""

from __future__ import annotations

import re
from math import pi
from typing import NamedTuple

# factor to SI, and powers of kg, m, s, rad and K
_TABLE: dict[str, tuple[float, tuple[int, int, int, int, int]]] = {
    "1": (1.0, (0, 0, 0, 0, 0)),
    "%": (0.01, (0, 0, 0, 0, 0)),
    "kg": (1.0, (1, 0, 0, 0, 0)),
    "g": (1e-3, (1, 0, 0, 0, 0)),
    "t": (1e3, (1, 0, 0, 0, 0)),
    "m": (1.0, (0, 1, 0, 0, 0)),
    "mm": (1e-3, (0, 1, 0, 0, 0)),
    "cm": (1e-2, (0, 1, 0, 0, 0)),
    "km": (1e3, (0, 1, 0, 0, 0)),
    "s": (1.0, (0, 0, 1, 0, 0)),
    "ms": (1e-3, (0, 0, 1, 0, 0)),
    "us": (1e-6, (0, 0, 1, 0, 0)),
    "min": (60.0, (0, 0, 1, 0, 0)),
    "h": (3600.0, (0, 0, 1, 0, 0)),
    "rad": (1.0, (0, 0, 0, 1, 0)),
    "deg": (pi / 180, (0, 0, 0, 1, 0)),
    "rev": (2 * pi, (0, 0, 0, 1, 0)),
    "rpm": (pi / 30, (0, 0, -1, 1, 0)),
    "Hz": (1.0, (0, 0, -1, 0, 0)),
    "N": (1.0, (1, 1, -2, 0, 0)),
    "kN": (1e3, (1, 1, -2, 0, 0)),
    "Nm": (1.0, (1, 2, -2, 0, 0)),
    "kNm": (1e3, (1, 2, -2, 0, 0)),
    "J": (1.0, (1, 2, -2, 0, 0)),
    "kJ": (1e3, (1, 2, -2, 0, 0)),
    "W": (1.0, (1, 2, -3, 0, 0)),
    "kW": (1e3, (1, 2, -3, 0, 0)),
    "Pa": (1.0, (1, -1, -2, 0, 0)),
    "kPa": (1e3, (1, -1, -2, 0, 0)),
    "MPa": (1e6, (1, -1, -2, 0, 0)),
    "K": (1.0, (0, 0, 0, 0, 1)),
    "bar": (1e5, (1, -1, -2, 0, 0)),
}
_FACTOR = re.compile(r"([A-Za-z%]{1,20}|1)\^?(-?\d)?")
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
# more is no quantity
LONGEST = 200
_POWERS = str.maketrans({"²": "2", "³": "3", "·": " ", "*": " ", "°": "deg"})


class Unit(NamedTuple):
    """Factor to SI, and powers of kg, m, s, rad and K."""

    factor: float
    powers: tuple[int, ...]


def parse(text: str) -> Unit:
    """Read a unit such as "N m s/rad", "kg.m2" or "1/s"; ValueError names the part that is not known."""
    factor, powers = 1.0, [0, 0, 0, 0, 0]
    # what follows a slash divides, up to the end: N m/rad, m/s2
    for side, part in enumerate(text.translate(_POWERS).split("/")):
        sign = -1 if side else 1
        for word in re.split(r"[\s.()]+", part.strip()):
            if not word:
                continue
            match = _FACTOR.fullmatch(word)
            if match is None or match[1] not in _TABLE:
                raise ValueError(word)
            power = sign * int(match[2] or 1)
            base, dimension = _TABLE[match[1]]
            factor *= base**power
            powers = [p + power * d for p, d in zip(powers, dimension, strict=True)]
    return Unit(factor, tuple(powers))


def split(text: str) -> tuple[float, str] | None:
    """Number and unit of a string such as "0.2 kg m2"; None when it does not start with a number."""
    match = _QUANTITY.fullmatch(text.strip()) if len(text) <= LONGEST else None
    return (float(match[1]), match[2]) if match else None


def known() -> list[str]:
    """The unit words that `parse` knows."""
    return list(_TABLE)
