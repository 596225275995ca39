"""What a Sankey picture shows of a table of losses: boxes, ribbons between them, and what leaves a box."""

from __future__ import annotations

from collections import Counter, defaultdict, deque
from collections.abc import Callable

from clutchwork.base import dataclass
from clutchwork.results.losses import LossTable

# ribbons below this part of the largest box are not drawn
LEAST = 2e-3
# loads so many columns before the last one are put there
NEAR = 4


@dataclass(frozen=True)
class Box:
    """An element or a shaft, with what it exchanges with the outside of the driveline."""

    name: str
    is_shaft: bool
    outside: float  # from outside, negative: to outside
    stored: float
    heat: float


@dataclass(frozen=True)
class Ribbon:
    """Energy from one box to another; negative: back."""

    start: str
    end: str
    energy: float


@dataclass(frozen=True)
class Graph:
    """Boxes in columns from left to right, and the ribbons between them, each to the right."""

    boxes: dict[str, Box]
    ribbons: tuple[Ribbon, ...]
    column: dict[str, int]
    left_out: int  # elements and shafts that nothing worth a ribbon goes through


def graph(table: LossTable, first: str | None, last: str | None) -> Graph:
    """The picture of a table.

    Parameters: first and last, the shafts of drive and load.
    """
    boxes = {
        line.element: Box(line.element, line.kind in ("shaft", "mass"), line.outside, line.stored, line.heat)
        for line in table.lines
    }
    size = {line.element: max(line.taken, line.given) for line in table.lines}
    least = LEAST * max(size.values(), default=0.0)
    ribbons = [Ribbon(*joint) for joint in table.joints if abs(joint[2]) > least]
    boxes, ribbons = _without_pass(boxes, ribbons, least)
    used = {name for ribbon in ribbons for name in (ribbon.start, ribbon.end)}
    shown = {name: _plain(box, least) for name, box in boxes.items() if name in used}
    column = _columns(shown, ribbons, first, last)
    turned = [r if column[r.start] < column[r.end] else Ribbon(r.end, r.start, -r.energy) for r in ribbons]
    merged = {line.element for line in table.lines} - boxes.keys()
    return Graph(shown, tuple(turned), column, len(table.lines) - len(shown) - len(merged))


def _plain(box: Box, least: float) -> Box:
    """Without what is too small to be seen."""
    outside, stored, heat = (x if abs(x) > least else 0.0 for x in (box.outside, box.stored, box.heat))
    return Box(box.name, box.is_shaft, outside, stored, heat)


def _without_pass(boxes: dict[str, Box], ribbons: list[Ribbon], least: float) -> tuple[dict[str, Box], list[Ribbon]]:
    """Without shafts between two elements that store nothing."""
    boxes, ribbons = dict(boxes), list(ribbons)
    for box in list(boxes.values()):
        at = [ribbon for ribbon in ribbons if box.name in (ribbon.start, ribbon.end)]
        if not box.is_shaft or abs(box.stored) > least or len(at) != 2:
            continue
        # ribbons start at elements and end at shafts
        one, other = at
        ribbons = [ribbon for ribbon in ribbons if ribbon not in at]
        larger = one if abs(one.energy) > abs(other.energy) else other
        ribbons.append(Ribbon(one.start, other.start, larger.energy if larger is one else -larger.energy))
        del boxes[box.name]
    return boxes, ribbons


def _columns(boxes: dict[str, Box], ribbons: list[Ribbon], first: str | None, last: str | None) -> dict[str, int]:
    """Columns by the structure of the driveline, from its drive to its load, also where energy goes back."""
    beside: dict[str, set[str]] = defaultdict(set)
    for ribbon in ribbons:
        beside[ribbon.start].add(ribbon.end)
        beside[ribbon.end].add(ribbon.start)
    order = _order(_by_distance(boxes, beside, first, last), boxes, ribbons, first, last)
    place = {name: number for number, name in enumerate(order)}
    column: dict[str, int] = {}
    for name in order:
        column[name] = max((column[other] + 1 for other in beside[name] if place[other] < place[name]), default=0)
    for name in reversed(order):
        before = [other for other in beside[name] if place[other] < place[name]]
        after = [column[other] for other in beside[name] if place[other] > place[name]]
        if after and not before:
            column[name] = min(after) - 1
        elif (
            (boxes[name].outside < 0.0 or beside[name] == {last})
            and not after
            and column[name] > max(column.values()) - NEAR
        ):
            # the loads of the end stand below each other
            column[name] = max(column.values())
    least = min(column.values(), default=0)
    return {name: number - least for name, number in column.items()}


def _by_distance(boxes: dict[str, Box], beside: dict[str, set[str]], first: str | None, last: str | None) -> list[str]:
    """Boxes by where they lie between drive and load."""
    start = first if first in boxes else max(boxes, key=lambda name: boxes[name].outside, default=None)
    here = _distances(beside, start)
    end = last if last in boxes else max(boxes, key=lambda name: here.get(name, 0), default=None)
    there = _distances(beside, end)

    def key(name: str) -> tuple[float, int]:
        a, b = here.get(name, 0), there.get(name, 0)
        return (a / (a + b) if a + b else 0.0, a)

    return sorted(boxes, key=key)


def _distances(beside: dict[str, set[str]], start: str | None) -> dict[str, int]:
    found = {} if start is None else {start: 0}
    waiting = deque(found)
    while waiting:
        name = waiting.popleft()
        for other in sorted(beside[name]):
            if other not in found:
                found[other] = found[name] + 1
                waiting.append(other)
    return found


def _order(
    order: list[str], boxes: dict[str, Box], ribbons: list[Ribbon], first: str | None, last: str | None
) -> list[str]:
    """An order in which little goes against the main direction, from drive to load or back."""
    ahead = 1.0 if _sent(ribbons, first, boxes) >= 0.0 else -1.0
    sent = [(r.start, r.end, r.energy) if ahead * r.energy > 0.0 else (r.end, r.start, -r.energy) for r in ribbons]
    largest = sum(abs(energy) for *_, energy in sent)
    # what acts on the last shaft alone is behind it, whether it drives or brakes
    joints = Counter(name for ribbon in ribbons for name in (ribbon.start, ribbon.end))
    loads = [ribbon.start for ribbon in ribbons if ribbon.end == last and joints[ribbon.start] == 1]

    def cost(one: list[str]) -> float:
        places = {name: number for number, name in enumerate(one)}
        back = sum(abs(energy) for start, end, energy in sent if places[start] > places[end])
        if first in places and last in places:
            back += largest * (places[first] > places[last])
            back += largest * sum(places[name] < places[last] for name in loads)
        return back

    tried = [_improved(one, cost) for one in (order, _greedy(order, sent))]
    return min(tried, key=cost)


def _improved(order: list[str], cost: Callable[[list[str]], float]) -> list[str]:
    """The order with single boxes moved as long as that helps."""
    best, improved = cost(order), True
    while improved:
        improved = False
        for name in list(order):
            rest = [other for other in order if other != name]
            tried = [[*rest[:k], name, *rest[k:]] for k in range(len(order))]
            costs = [cost(one) for one in tried]
            least = min(costs)
            if least < best * (1.0 - 1e-9):
                order, best, improved = tried[costs.index(least)], least, True
    return order


def _greedy(order: list[str], sent: list[tuple[str, str, float]]) -> list[str]:
    """Boxes that only take go to the right, those that only give to the left, then those that give most more.

    Source: P. Eades, X. Lin, W. F. Smyth 1993, doi:10.1016/0020-0190(93)90079-O.
    """
    left, right, rest = list[str](), list[str](), list(order)
    while rest:
        there = set(rest)
        gives = {name: sum(abs(e) for a, b, e in sent if a == name and b in there) for name in rest}
        takes = {name: sum(abs(e) for a, b, e in sent if b == name and a in there) for name in rest}
        sinks = [name for name in rest if not gives[name]]
        sources = [name for name in rest if not takes[name]]
        if sinks:
            right[:0] = [sinks[-1]]
            rest.remove(sinks[-1])
        else:
            chosen = sources[0] if sources else max(rest, key=lambda name: gives[name] - takes[name])
            left.append(chosen)
            rest.remove(chosen)
    return [*left, *right]


def _sent(ribbons: list[Ribbon], first: str | None, boxes: dict[str, Box]) -> float:
    """What the drive gives to the line; negative: what comes back to it."""
    if first not in boxes:
        return 1.0
    given = 0.0
    for ribbon in ribbons:
        # sources at the shaft of the drive, and what that shaft gives from its own
        if ribbon.end == first and boxes[ribbon.start].outside:
            given += ribbon.energy
    return given - boxes[first].stored
