"""How long levers are and at which height they hang: shared members level where it can be, all others apart."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from clutchwork.diagrams.lever.points import Lever, turned

PITCH, LEAST = 11.0, 20.5  # px between heights of different levers, and of points of one
LONG, LONGEST = 168.0, 340.0
LENGTHS = (1.0, 1.12, 0.9, 1.25, 1.4, 0.8, 1.6, 1.8)


class Hung(NamedTuple):
    """A lever at its place: heights of its members [px]."""

    lever: Lever
    heights: Mapping[str, float]


def hung(levers: Sequence[Lever]) -> list[Hung]:
    """Heights of all levers, one after the other."""
    made = list[Hung]()
    for lever in levers:
        made.append(min(_choices(lever, made), key=lambda choice: _worth(choice, made)))
    low = min(height for one in made for height in one.heights.values())
    return [Hung(lever, {m: round(height - low, 6) for m, height in heights.items()}) for lever, heights in made]


def _choices(lever: Lever, before: Sequence[Hung]) -> Iterator[Hung]:
    """Both ways up, in several lengths, level with members of levers before it."""
    for one in (lever, turned(lever)):
        places = {member: float(place) for member, place in one.places.items()}
        steps = sorted(places.values())
        least = max(LEAST / (b - a) for a, b in pairwise(steps))
        lengths = [max(LONG * factor, least) for factor in LENGTHS]
        known = {m: heights[m] for _, heights in before for m in places if m in heights}
        shared = sorted(known, key=lambda m: places[m])
        # two shared members are level with a length of its own
        for a, b in ((a, b) for a in shared for b in shared if places[a] < places[b]):
            lengths.insert(0, (known[b] - known[a]) / (places[b] - places[a]))
        for length in lengths:
            if not least - 1e-6 <= length <= max(LONGEST, least):
                continue
            bases = [known[m] - length * places[m] for m in shared] + [7.0 * n for n in range(-24, 25)]
            for base in bases if before else [0.0]:
                yield Hung(one, {m: base + length * place for m, place in places.items()})


def _worth(choice: Hung, before: Sequence[Hung]) -> float:
    """The less the better: heights too close, shared members not level, far up or down."""
    cost = 0.0
    others = {round(height, 6) for _, heights in before for height in heights.values()}
    for height in choice.heights.values():
        cost += sum(1000.0 for other in others if 1e-4 < abs(height - other) < PITCH)
    for number, (_, heights) in enumerate(before):
        near = 1.0 / (len(before) - number)
        for member, height in choice.heights.items():
            if member in heights:
                cost += near * min(abs(heights[member] - height), 60.0)
            # a point at the height of another member is in the way of its lines
            elif any(abs(height - other) < 1e-4 for other in heights.values()):
                cost += 40.0 * near
    if others:
        cost += 2.0 * max(0.0, max(choice.heights.values()) - max(others), min(others) - min(choice.heights.values()))
    return cost + 0.01 * (max(choice.heights.values()) - min(choice.heights.values()))
