"""Where the boxes and ribbons of a Sankey picture lie, in mm."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from itertools import pairwise

from clutchwork.base import dataclass
from clutchwork.plot.sankey_graph import Graph, Ribbon

BAR = 2.6  # width of a box
LABEL = 7.5  # height of name and number above a box
ARROW = 10.0  # height of an arrow up or down with its number, less the bend
GAP = 3.0  # between boxes of a column
SIDE = 12.0  # beside the first and the last column
LANE = 1.2  # between a ribbon that passes a column and its neighbours
THICK = 26.0  # largest box
HIGH = 150.0  # most of all
SWEEPS = 24


@dataclass(frozen=True)
class BoxPlace:
    """A box: left edge, middle, height; ends of its ribbons are sorted by where they go."""

    x: float
    y: float
    high: float


@dataclass(frozen=True)
class Path:
    """A ribbon through the columns between its boxes: (x, y) of its middle at both sides of each."""

    ribbon: Ribbon
    points: tuple[tuple[float, float], ...]
    thick: float


@dataclass(frozen=True)
class SankeyLayout:
    """The whole picture."""

    wide: float
    high: float
    scale: float  # mm per unit
    boxes: dict[str, BoxPlace]
    paths: tuple[Path, ...]


@dataclass(frozen=True)
class Item:
    """What stands in a column: a box, or the lane of a ribbon that passes."""

    name: str
    column: int
    high: float  # of the bar
    above: float
    below: float


def places(graph: Graph, wide: float) -> SankeyLayout:
    """Boxes and ribbons in a width [mm]."""
    sides = _sides(graph)
    largest = max((max(pair) for pair in sides.values()), default=0.0)
    scale = THICK / (largest or 1.0)
    items, chains = _items(graph, sides, scale)
    high = _highest(items)
    if high > HIGH:
        # labels keep their size
        fixed = max(_needed(column) - sum(item.high for item in column) for column in _by_column(items).values())
        scale *= max(0.2, (HIGH - fixed) / max(1.0, high - fixed))
        items, chains = _items(graph, sides, scale)
        high = _highest(items)
    middle = _middles(items, chains, high)
    tops = [middle[item.name] + 0.5 * item.high + item.above for item in items]
    floor = min((middle[item.name] - 0.5 * item.high - item.below for item in items), default=0.0)
    high = max(tops, default=high) - floor
    middle = {name: y - floor for name, y in middle.items()}
    lefts, wide = _lefts(graph, scale, wide)
    left = {item.name: lefts[item.column] for item in items}
    boxes = {
        item.name: BoxPlace(left[item.name], middle[item.name], item.high) for item in items if item.name in graph.boxes
    }
    return SankeyLayout(wide, high, scale, boxes, tuple(_paths(chains, left, middle, boxes, graph, scale)))


def _lefts(graph: Graph, scale: float, wide: float) -> tuple[list[float], float]:
    """Left edges of the columns, further apart where a broad arrow bends off; and the width of it all."""
    count = 1 + max(graph.column.values(), default=0)
    need = [0.0] * (count + 1)
    for name, box in graph.boxes.items():
        column, bend = graph.column[name], scale * max(box.heat, abs(box.stored))
        side = column if box.stored < 0.0 else column + 1
        need[side] = max(need[side], bend + BAR + 7.0 if bend else 0.0)
    even = (wide - 2.0 * SIDE - BAR) / max(1, count - 1)
    left = [max(SIDE, need[0])]
    for gap in need[1:-1]:
        left.append(left[-1] + max(even, gap))
    return left, max(wide, left[-1] + BAR + max(SIDE, need[-1]))


def _sides(graph: Graph) -> dict[str, tuple[float, float]]:
    """What is joined to the left and to the right of each box."""
    left: dict[str, float] = defaultdict(float)
    right: dict[str, float] = defaultdict(float)
    for ribbon in graph.ribbons:
        right[ribbon.start] += abs(ribbon.energy)
        left[ribbon.end] += abs(ribbon.energy)
    for name, box in graph.boxes.items():
        left[name] += max(0.0, -box.stored)
        right[name] += max(0.0, box.heat) + max(0.0, box.stored)
    return {name: (left[name], right[name]) for name in graph.boxes}


def _items(
    graph: Graph, sides: dict[str, tuple[float, float]], scale: float
) -> tuple[list[Item], list[tuple[Ribbon, list[str]]]]:
    """Boxes, lanes, and what each ribbon goes through."""
    items = []
    for name, box in graph.boxes.items():
        above = LABEL + (ARROW + scale * abs(box.stored) if box.stored else 0.0)
        below = ARROW + scale * box.heat if box.heat > 0.0 else 0.0
        items.append(Item(name, graph.column[name], scale * max(sides[name]), above, below))
    chains = []
    for number, ribbon in enumerate(graph.ribbons):
        lanes = []
        for column in range(graph.column[ribbon.start] + 1, graph.column[ribbon.end]):
            lanes.append(f"{number}/{column}")
            items.append(Item(lanes[-1], column, scale * abs(ribbon.energy), LANE, LANE))
        chains.append((ribbon, [ribbon.start, *lanes, ribbon.end]))
    return items, chains


def _by_column(items: Iterable[Item]) -> dict[int, list[Item]]:
    made: dict[int, list[Item]] = defaultdict(list)
    for item in items:
        made[item.column].append(item)
    return made


def _highest(items: Iterable[Item]) -> float:
    return max((_needed(column) for column in _by_column(items).values()), default=20.0)


def _needed(column: list[Item]) -> float:
    return sum(item.high + item.above + item.below + GAP for item in column)


def _middles(items: list[Item], chains: list[tuple[Ribbon, list[str]]], high: float) -> dict[str, float]:
    """Middle of every bar: near those that it is joined to, without overlap."""
    beside: dict[str, list[tuple[str, float]]] = defaultdict(list)
    for ribbon, chain in chains:
        for one, other in pairwise(chain):
            weight = abs(ribbon.energy)
            beside[one].append((other, weight))
            beside[other].append((one, weight))
    columns = _by_column(items)
    middle = {item.name: 0.5 * high for item in items}
    for column in columns.values():
        _spread(column, middle, high, keep=True)
    for sweep in range(SWEEPS):
        order = sorted(columns, reverse=bool(sweep % 2))
        for number in order:
            for item in columns[number]:
                total = sum(weight for _, weight in beside[item.name])
                if total:
                    middle[item.name] = sum(middle[other] * w for other, w in beside[item.name]) / total
            _spread(columns[number], middle, high, keep=False)
    return middle


def _spread(column: list[Item], middle: dict[str, float], high: float, keep: bool) -> None:
    """Push the items of a column apart, as little as need be: blocks of neighbours move together."""
    order = column if keep else sorted(column, key=lambda item: -middle[item.name])
    blocks: list[tuple[list[Item], float]] = []  # items from top to bottom, top of the block
    for item in order:
        blocks.append(([item], middle[item.name] + 0.5 * item.high + item.above))
        while len(blocks) > 1 and blocks[-2][1] - _needed(blocks[-2][0]) < blocks[-1][1]:
            (upper, top), (lower, second) = blocks[-2:]
            # both where they would like to be, on the average
            shifted = second + _needed(upper)
            joined = (top * len(upper) + shifted * len(lower)) / (len(upper) + len(lower))
            blocks[-2:] = [([*upper, *lower], joined)]
    tops = [min(high, wanted) for _, wanted in blocks]
    for number in range(1, len(blocks)):
        tops[number] = min(tops[number], tops[number - 1] - _needed(blocks[number - 1][0]))
    floor = 0.0
    for number in reversed(range(len(blocks))):
        tops[number] = max(tops[number], floor + _needed(blocks[number][0]))
        floor = tops[number]
    for (block, _), top in zip(blocks, tops, strict=True):
        for item in block:
            middle[item.name] = top - item.above - 0.5 * item.high
            top -= item.high + item.above + item.below + GAP


def _paths(
    chains: list[tuple[Ribbon, list[str]]],
    left: dict[str, float],
    middle: dict[str, float],
    boxes: dict[str, BoxPlace],
    graph: Graph,
    scale: float,
) -> Iterable[Path]:
    """Ribbons with their ends one below another at each box, in the order of where they come from."""
    starts: dict[str, list[int]] = defaultdict(list)
    ends: dict[str, list[int]] = defaultdict(list)
    for number, (ribbon, _) in enumerate(chains):
        starts[ribbon.start].append(number)
        ends[ribbon.end].append(number)
    at_start: dict[int, float] = {}
    at_end: dict[int, float] = {}
    for name, box in graph.boxes.items():
        place = boxes[name]
        right = sorted(starts[name], key=lambda k: -middle[chains[k][1][1]])
        top = place.y + 0.5 * place.high - scale * max(0.0, box.stored)
        for k in right:
            thick = scale * abs(chains[k][0].energy)
            at_start[k] = top - 0.5 * thick
            top -= thick
        top = place.y + 0.5 * place.high - scale * max(0.0, -box.stored)
        for k in sorted(ends[name], key=lambda k: -middle[chains[k][1][-2]]):
            thick = scale * abs(chains[k][0].energy)
            at_end[k] = top - 0.5 * thick
            top -= thick
    for number, (ribbon, chain) in enumerate(chains):
        points = [(left[ribbon.start] + BAR, at_start[number])]
        for lane in chain[1:-1]:
            points += [(left[lane], middle[lane]), (left[lane] + BAR, middle[lane])]
        points.append((left[ribbon.end], at_end[number]))
        yield Path(ribbon, tuple(points), scale * abs(ribbon.energy))
