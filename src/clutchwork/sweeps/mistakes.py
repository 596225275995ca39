"""Mistakes of many values in few lines."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from clutchwork.base import Problem

# so many mistakes of a sweep are named
MOST_PROBLEMS = 20
# so many values of one name with the same mistake are named one by one
MOST_ALIKE = 3


def few(problems: Iterable[Problem], most: int = MOST_PROBLEMS) -> list[Problem]:
    """Mistakes, each once; where many values have the same one, the first of them and how many there are."""
    alike = dict[Problem, list[Problem]]()
    for one in dict.fromkeys(problems):
        alike.setdefault(replace(one, value=""), []).append(one)
    return [told for of in alike.values() for told in _told(of)][:most]


def _told(alike: list[Problem]) -> list[Problem]:
    if len(alike) <= MOST_ALIKE:
        return alike
    first = alike[0]
    return [replace(first, message=f"{first.message}, and {len(alike) - 1} other values are like it")]
