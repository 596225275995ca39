"""Room that a run needs for matrices without their zeros, at most in any mode: docs/theory/reduction.md."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Mapping, Sequence
from itertools import accumulate

from clutchwork.assembly.dependence import dependence
from clutchwork.assembly.records import Array
from clutchwork.assembly.sparse import supports
from clutchwork.declare.layout import FEW_SPEEDS

Support = Sequence[int]


def rooms(arrays: Mapping[str, Array]) -> dict[str, int]:
    """The rooms of `layout.COUNTS`; none for few speeds, whose matrices are kept whole."""
    speeds = len(arrays["massless"])
    if speeds <= FEW_SPEEDS:
        return {}
    mass, elements, contacts = (supports(arrays, name) for name in ("mass", "element_rate", "contact_rate"))
    low = _lowest(speeds, mass)
    # behind a speed nothing is coupled with those before its rest
    rest = list(accumulate(reversed(low), min))[::-1]
    white = [_filled(row, low, rest) for row in (*elements, *contacts)]
    spread, extra = _spread(speeds, contacts)
    envelope = _envelope(_lowest(speeds, (*mass, *elements, *contacts)), extra)
    reduced = sum(spread[i] * spread[j] for i, row in enumerate(mass) for j in row)
    spares, largest = dependence(arrays)
    return {
        "factor_room": sum(i - low[i] + 1 for i in range(speeds)),
        "direction_room": sum(map(len, white)),
        "mobility_room": _overlaps(white[len(elements) :]),
        # one more in each row while the elimination is on its way
        "expansion_room": sum(spread) + speeds,
        "rate_room": sum(min(speeds, sum(spread[i] for i in row)) for row in (*elements, *contacts)),
        "mass_room": min(reduced, envelope),
        "envelope_room": envelope,
        "spares": spares,
        "set_size": largest,
    }


def _lowest(speeds: int, rows: Iterable[Support]) -> list[int]:
    """The first speed that each one is coupled with by a row."""
    low = list(range(speeds))
    for row in rows:
        for speed in row:
            low[speed] = min(low[speed], row[0])
    return low


def _filled(row: Support, low: Sequence[int], rest: Sequence[int]) -> list[int]:
    """Where a row has numbers once it is solved with the factor of a matrix whose rows start at `low`."""
    if not row:
        return []
    filled, own, last = list[int](), set(row), -1
    for speed in range(row[0], len(low)):
        if speed in own or low[speed] <= last:
            filled.append(speed)
            last = speed
        elif speed > row[-1] and rest[speed] > last:
            break
    return filled


def _overlaps(rows: Sequence[Support]) -> int:
    """Pairs of rows, each with itself too, whose stretches overlap."""
    ends = sorted((row[-1], row[0]) for row in rows if row)
    lasts = [last for last, _ in ends]
    return len(rows) - len(ends) + sum(i - bisect_left(lasts, first) + 1 for i, (_, first) in enumerate(ends))


def _spread(speeds: int, contacts: Sequence[Support]) -> tuple[list[int], list[tuple[int, int, int]]]:
    """Over how many reduced speeds each speed can spread, and the stretches of speeds that wide contacts join.

    A stretch is (first, last, more): its contacts have `more` speeds than two each would.
    """
    group = _joined(speeds, contacts)
    sizes, more = [0] * speeds, [0] * speeds
    first, last = [speeds] * speeds, [0] * speeds
    for speed, root in enumerate(group):
        sizes[root] += 1
        first[root], last[root] = min(first[root], speed), speed
    for row in contacts:
        if row:
            more[group[row[0]]] += max(0, len(row) - 2)
    spread = [min(sizes[root], 1 + more[root]) for root in group]
    return spread, [(first[root], last[root], more[root]) for root in range(speeds) if more[root]]


def _joined(speeds: int, rows: Sequence[Support]) -> list[int]:
    """A number of the group of each speed; rows join groups."""
    parent = list(range(speeds))

    def root(speed: int) -> int:
        while parent[speed] != speed:
            parent[speed] = speed = parent[parent[speed]]
        return speed

    for row in rows:
        for speed in row[1:]:
            parent[root(speed)] = root(row[0])
    return [root(speed) for speed in range(speeds)]


def _envelope(low: Sequence[int], extra: Sequence[tuple[int, int, int]]) -> int:
    """Most numbers between the first one of each row and the diagonal, after any contraction of joined speeds."""
    speeds = len(low)
    # changes from one column to the next: rows that reach over it; columns that contacts of several speeds add
    over, add, times = ([0] * (speeds + 1) for _ in range(3))
    for row, start in enumerate(low):
        over[start] += 1
        over[row + 1] -= 1
    for first, last, more in extra:
        add[min(low[first : last + 1])] += more
        add[last + 1] -= more
        times[first] += more
        times[last + 1] -= more
    columns = zip(accumulate(over), accumulate(add), accumulate(times), strict=True)
    most = sum(min(speeds, front + more) * (1 + shared) for front, more, shared in columns)
    return min(most, speeds * (speeds + 1) // 2)
