"""Contacts whose directions depend on each other: locked together, the share of each in their load is a convention."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from math import hypot

from clutchwork.assembly.records import Array
from clutchwork.assembly.sparse import entries

ROUND_OFF = 1e-9
# share of a contact in the direction of another that may still count in the core
LEAST_SHARE = 1e-13
Direction = Mapping[int, float]


def dependent_sets(
    names: Sequence[str], rates: Sequence[Direction], closed: Collection[str] | None = None
) -> tuple[tuple[str, ...], ...]:
    """Sets of contacts, among the closed ones or all, that depend on each other when they are locked together.

    `rates` are the directions of the named contacts, share by independent speed. Parallel clutches are such a set, or
    three clutches in a ring. Their motion and the load that they carry together are unique; how they share
    it is a convention: by capacity, or, beside gears with losses, in some way that keeps all limits.
    """
    places = [place for place, name in enumerate(names) if closed is None or name in closed]
    sets = _Elimination([rates[place] for place in places]).sets(ROUND_OFF)
    return tuple(tuple(names[places[i]] for i in group) for group in sets)


def dependence(arrays: Mapping[str, Array]) -> tuple[int, int]:
    """How many locked contacts can depend on others at most, and how many contacts the largest such set has."""
    found = _Elimination(entries(arrays, "contact_rate"))
    return len(found.spares), max(map(len, found.sets(LEAST_SHARE)), default=0)


class _Elimination:
    """Directions reduced one after the other by those before them; spares are those of which nothing is left."""

    def __init__(self, directions: Sequence[Direction]) -> None:
        self.directions = directions
        # pivot, place of the direction, what is left of it, and how much was taken of those before, by number
        self.solved = list[tuple[int, int, Direction, Direction]]()
        self.number = dict[int, int]()  # of each pivot
        self.spares = list[int]()
        for place, given in enumerate(directions):
            size = hypot(*given.values())
            # what only prescribed speeds move has no load to share
            if size == 0.0:
                continue
            left, taken = self._reduced({column: value / size for column, value in given.items()})
            pivot = max(left, key=lambda column: abs(left[column]), default=None)
            if pivot is None or abs(left[pivot]) <= ROUND_OFF:
                self.spares.append(place)
                continue
            self.number[pivot] = len(self.solved)
            self.solved.append((pivot, place, left, taken))

    def _reduced(self, left: dict[int, float]) -> tuple[dict[int, float], dict[int, float]]:
        """What the directions so far leave of one, and how much of each of them is taken, by its number."""
        taken: dict[int, float] = {}
        while waiting := [self.number[column] for column in left if column in self.number]:
            # what is taken brings in pivots of later ones alone
            first = min(waiting)
            pivot, _, row, _ = self.solved[first]
            factor = taken[first] = left[pivot] / row[pivot]
            for column, value in row.items():
                left[column] = left.get(column, 0.0) - factor * value
            del left[pivot]
        return left, taken

    def sets(self, least: float) -> list[list[int]]:
        """Places of the directions that depend on each other; shares up to `least` do not count."""
        label = list(range(len(self.directions)))
        for spare in self.spares:
            for carrier in self._carriers(spare, least):
                old, new = label[carrier], label[spare]
                label = [new if item == old else item for item in label]
        groups: dict[int, list[int]] = {}
        for place, item in enumerate(label) if self.spares else ():
            groups.setdefault(item, []).append(place)
        return [group for group in groups.values() if len(group) > 1]

    def _carriers(self, spare: int, least: float) -> list[int]:
        """Places of the independent directions of which a spare is made."""
        size = hypot(*self.directions[spare].values())
        _, shares = self._reduced({column: value / size for column, value in self.directions[spare].items()})
        carriers = list[int]()
        # a solved row is its own direction less those taken from it: from the last to the first
        while shares:
            last = max(shares)
            share, (_, place, _, taken) = shares.pop(last), self.solved[last]
            if abs(share) > least:
                carriers.append(place)
            for number, value in taken.items():
                shares[number] = shares.get(number, 0.0) - share * value
        return carriers
