"""Lines over one number: linear between their points, held outside."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence

Line = Sequence[tuple[float, float]]


def at(line: Line, x: float) -> float:
    """A line at a number."""
    place = bisect_right(line, x, key=_first)
    if place == 0 or place == len(line):
        return float(line[max(place - 1, 0)][1])
    (low, first), (high, last) = line[place - 1], line[place]
    return float(first + (x - low) / (high - low) * (last - first))


def _first(point: tuple[float, float]) -> float:
    return point[0]
