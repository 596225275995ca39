"""Units at the border: text such as "0.2 kg m2" or "30 bar" becomes a number in SI.

Behind the border there is only SI. `declare.unit_words` lists the words.
"""

from __future__ import annotations

import re
from functools import cache, lru_cache
from typing import NamedTuple

from clutchwork.declare.unit_words import OTHER_ZERO, TABLE, TOLERANT, Powers

_FACTOR = re.compile(r"([A-Za-z%]{1,20}|1)\^?(-?[1-9])?")
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
_COMMA = re.compile(r"\s*[-+]?\d*,\d+([eE][-+]?\d+)?\s*[^\d,;]*")
# what a unit looks like: factors, and at most one bracket behind a slash
_SHAPE = re.compile(r"\s*(?:1(?=\s*/)|1\s*|[^\s./()1][^()/]*)(?:/[^()/]+|/\s*\([^()/]+\))*\s*")
# more is no quantity
LONGEST = 200
_SIGNS = {"·": " ", "⋅": " ", "*": " ", "°": "deg", "µ": "u", "μ": "u", "−": "-", "⁻": "-"}
_POWERS = str.maketrans(_SIGNS | dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789", strict=True)))
# per minute, of what turns
_TURNS = re.compile(r"1\s*/\s*min|min\s*\^?\s*-1")
NONE: Powers = (0, 0, 0, 0, 0, 0)
KELVIN: Powers = (0, 0, 0, 0, 1, 0)


class Unit(NamedTuple):
    """Factor to SI, and powers of kg, m, s, rad, K and A."""

    factor: float
    powers: tuple[int, ...]


class Scale(NamedTuple):
    """Conversion to SI: `number * factor + zero`."""

    factor: float
    zero: float = 0.0

    def si(self, number: float) -> float:
        """A number in SI; 35 mm are 0.035 m to the last bit, which no product with 0.001 promises."""
        parts = 1.0 / self.factor if 0.0 < self.factor < 1.0 else 0.5
        # minus zero becomes zero, so that what is written reads back to the same bits
        return number / parts + self.zero if parts.is_integer() else number * self.factor + self.zero


def parse(text: str) -> Unit:
    """Read a unit such as "N m s/rad", "kg.m2" or "1/s"; ValueError names the part that is not known."""
    return _parsed(_plain(text))


def _plain(text: str) -> str:
    return text.replace("**", "^").translate(_POWERS)


@lru_cache(1000)
def _parsed(text: str) -> Unit:
    if text.strip() == "-":
        return Unit(1.0, NONE)
    if text.strip() and (not _SHAPE.fullmatch(text) or text.strip().endswith((".", "/"))):
        raise ValueError(text.strip())
    # factors are put together without round-off: a cm3 is 1e-6 m3 to the last bit
    from fractions import Fraction

    factor, powers = Fraction(1), [0, 0, 0, 0, 0, 0]
    # what follows a slash divides, up to the end: N m/rad, m/s2
    for side, part in enumerate(text.split("/")):
        sign = -1 if side else 1
        words = [word for word in re.split(r"[\s.()]+", part.strip()) if word]
        for word in words:
            match = _FACTOR.fullmatch(word)
            name = match and (match[1] if match[1] in TABLE else TOLERANT.get(match[1].lower(), ""))
            # a one stands alone, as in 1/s
            if match is None or name not in TABLE or (word == "1" and (len(words) > 1 or side)):
                raise ValueError(word)
            power = sign * int(match[2] or 1)
            base, dimension = TABLE[name]
            factor *= Fraction(repr(base)) ** power
            powers = [p + power * d for p, d in zip(powers, dimension, strict=True)]
    try:
        return Unit(float(factor), tuple(powers))
    except OverflowError:
        raise ValueError(text) from None


@cache
def powers_of(text: str) -> tuple[int, ...]:
    """Powers of the base units in a unit that is known."""
    return parse(text).powers


def scale(text: str, wanted: tuple[str, ...], *, difference: bool = False) -> Scale | None:
    """Conversion from a unit to one of the expected units; None if it fits none of them.

    ValueError names the part that is not known. Parameters: difference, whether the number is a difference, to which no
    offset applies.
    """
    plain = _plain(text)
    powers = {powers_of(unit) for unit in wanted}
    other = other_zero(text)
    if other and KELVIN in powers and not difference:
        return Scale(*OTHER_ZERO[other])
    found = next((unit for unit in _readings(plain) if unit.powers in powers), None)
    return Scale(found.factor) if found else None


def other_zero(text: str) -> str:
    """The unit of temperature with an offset zero that a word means; empty if none."""
    word = _plain(text).strip()
    word = TOLERANT.get(word.lower(), word)
    return word if word in OTHER_ZERO else ""


def turns(text: str) -> bool:
    """Whether a unit is 1/min, which for rotation means revolutions."""
    return _TURNS.fullmatch(_plain(text).strip()) is not None


def _readings(text: str) -> list[Unit]:
    """Possible meanings of a unit: lb may be a force, 1/min a speed of rotation."""
    found = [_parsed(text)]
    if re.search(r"\blb\b", text):
        found.append(_parsed(re.sub(r"\blb\b", "lbf", text)))
    if turns(text):
        found.append(_parsed("rpm"))
    return found


def split(text: str) -> tuple[float, str] | None:
    """Number and unit of a string such as "0.2 kg m2"; None when it does not start with a number."""
    match = _QUANTITY.fullmatch(text.strip().replace("−", "-")) if len(text) <= LONGEST else None
    # a decimal comma is not the beginning of a unit
    return (float(match[1]), match[2]) if match and not match[2].startswith(",") else None


def has_comma(text: str) -> bool:
    """Whether a string is a number with a decimal comma, and maybe a unit."""
    return len(text) <= LONGEST and _COMMA.fullmatch(text) is not None


def known() -> list[str]:
    """The unit words that `parse` knows."""
    return list(TABLE)
