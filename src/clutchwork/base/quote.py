"""Values and names as messages show them: short, on one line, and nothing that steers a terminal."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable
from itertools import islice
from typing import Any

LONGEST = 80
MOST_NAMES = 50


class _Short(reprlib.Repr):
    """`repr` that stays short whatever it is given."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlist = self.maxtuple = self.maxdict = self.maxset = self.maxarray = 6
        self.maxstring = self.maxother = self.maxlong = LONGEST
        self.maxlevel = 4

    def repr_int(self, x: int, level: int) -> str:
        """An integer; Python refuses to write one of more than 4300 digits in decimals."""
        return f"a number of {x.bit_length()} bits" if x.bit_length() > 10_000 else super().repr_int(x, level)

    def repr_dict(self, x: dict[Any, Any], level: int) -> str:
        """A table in its own order."""
        if level <= 0:
            return "{...}"
        entries = [f"{self.repr1(key, level - 1)}: {self.repr1(x[key], level - 1)}" for key in islice(x, self.maxdict)]
        return f"{{{', '.join([*entries, *(['...'] if len(x) > self.maxdict else [])])}}}"


_SHORT = _Short()


def quote(value: object) -> str:
    """A value as Python writes it, the middle left out where it is long."""
    return shortened(_SHORT.repr(value))


def shortened(text: str, longest: int = 4 * LONGEST) -> str:
    """A string without its middle where it is long."""
    if len(text) <= longest:
        return text
    half = (longest - 3) // 2
    return f"{text[:half]}...{text[-half:]}"


def apart(value: float, other: float) -> str:
    """A number with at least six digits, and enough to differ from another one."""
    digits = (count for count in range(6, 17) if f"{value:.{count}g}" != f"{other:.{count}g}")
    return f"{value:.{next(digits, 6)}g}"


def measured(value: float, unit: str, other: float | None = None) -> str:
    """A number with its unit, which is left out where it is 1.

    Parameters: other, a number that it must not look like.
    """
    number = f"{value:g}" if other is None else apart(value, other)
    return number if unit in ("", "1") else f"{number} {unit}"


def printable(text: str) -> str:
    """A string whose control characters, and others that cannot be printed, are written as escapes."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def listed(names: Iterable[object]) -> str:
    """Names one after another, the first ones where there are many."""
    known = [shortened(printable(str(name)), LONGEST) for name in names]
    more = len(known) - MOST_NAMES
    return ", ".join(known) if more <= 0 else f"{', '.join(known[:MOST_NAMES])} and {more} more"
