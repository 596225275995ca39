"""The precisions of an exported core, for the command line too."""

from __future__ import annotations

from clutchwork.base import quote

PRECISIONS = ("double", "single")


def is_single(precision: str) -> bool:
    """Whether numbers of steps are single; anything but the words is refused."""
    if precision not in PRECISIONS:
        raise ValueError(f"precision is {quote(precision)}: give {' or '.join(map(quote, PRECISIONS))}")
    return precision == "single"
