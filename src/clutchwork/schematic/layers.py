"""Things in layers from left to right, and the lines between neighbouring layers."""

from __future__ import annotations

from dataclasses import field
from typing import Any

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.extras import need
from clutchwork.schematic.cells import Cell
from clutchwork.schematic.diagram import Thing
from clutchwork.schematic.flow import Flow
from clutchwork.schematic.symbols.symbol import RIGHT

PASS = 5.0  # pt that a passing line needs above and below


@dataclass(frozen=True, eq=False)
class Spot:
    """A position in a layer: a cell, or a line that passes through."""

    number: int
    layer: int
    up: float
    down: float
    cell: Cell | None = None


@dataclass(frozen=True)
class End:
    """An end of a line: a spot, and how far above its middle."""

    spot: int
    height: float = 0.0


@dataclass(frozen=True, eq=False)
class NodeLines:
    """The lines of one node between a layer and the next: from its trunk to all others."""

    node: Thing
    layer: int  # the left one
    trunk: End
    left: list[End]  # all ends in the left layer, the trunk among them
    right: list[End]
    weight: dict[End, float] = field(default_factory=dict)

    @property
    def others(self) -> list[End]:
        """All ends but the trunk."""
        return [end for end in (*self.left, *self.right) if end != self.trunk]


@dataclass(frozen=True, eq=False)
class Layers:
    """All spots and lines of one connected part."""

    spots: list[Spot]
    lines: list[NodeLines]
    count: int  # of layers


def linear_program(cost: Any, rows: Any, bounds: Any, limits: Any) -> Any:
    """The x with the least `cost x` where `rows x <= bounds`."""
    optimize = need("scipy.optimize", "draw", "a schematic")
    sparse = need("scipy.sparse", "draw", "a schematic")
    values, (places, columns) = rows
    matrix = sparse.csr_array((values, (places, columns)), shape=(len(bounds), len(cost)))
    return optimize.linprog(cost, A_ub=matrix, b_ub=bounds, bounds=limits, method="highs-ds").x


def ranks(count: int, arcs: list[tuple[int, int, float]]) -> list[int]:
    """A layer for each of `count` things, so that arcs (from, to, weight) go right and are short."""
    if not arcs:
        return [0] * count
    cost = np.zeros(count)
    values, places, columns = list[float](), list[int](), list[int]()
    for row, (start, stop, weight) in enumerate(arcs):
        cost[start] -= weight
        cost[stop] += weight
        values += [1.0, -1.0]
        places += [row, row]
        columns += [start, stop]
    found = linear_program(cost, (values, (places, columns)), -np.ones(len(arcs)), (0, None))
    # the rows of such a program have whole solutions
    layers = [round(float(value)) for value in found]
    return [layer - min(layers) for layer in layers]


def layered(cells: list[Cell], flow: Flow) -> Layers:
    """The layers of one connected part."""
    place = {id(cell.thing): number for number, cell in enumerate(cells)}
    layer = ranks(len(cells), list(_arcs(cells, place)))
    spots = [
        Spot(k, layer[k], max(cell.box.high, 0.0) + 5.0, max(-cell.box.low, 0.0) + 5.0, cell)
        for k, cell in enumerate(cells)
    ]
    lines = [one for cell in cells if cell.thing.is_node for one in _lines(cell, cells, place, layer, spots, flow)]
    return Layers(spots, lines, max(layer) + 1)


def _arcs(cells: list[Cell], place: dict[int, int]) -> Any:
    for cell in cells:
        for port, node in cell.thing.pins.items() if not cell.thing.is_node else ():
            here, there = place[id(cell.thing)], place[id(node)]
            yield (here, there, 1.0) if cell.pins[port][0] == RIGHT else (there, here, 1.0)


def _lines(
    cell: Cell, cells: list[Cell], place: dict[int, int], layer: list[int], spots: list[Spot], flow: Flow
) -> Any:
    """The lines of one node, to the right and to the left; what passes a layer gets a spot there."""
    home, node = place[id(cell.thing)], cell.thing
    ends: dict[int, dict[int, list[tuple[End, float]]]] = {1: {}, -1: {}}
    for other in cells:
        for port, (side, height) in other.pins.items():
            if other.thing.pins[port] is node:
                number = place[id(other.thing)]
                # what has two ports is drawn straight before a set of gears beside it
                plain = 0.5 * (len(other.thing.pins) == 2)
                weight = 1.0 + plain + 6.0 * flow.weight.get((id(other.thing), port), 0.0)
                ends[-side].setdefault(layer[number], []).append((End(number, height), weight))
    for way, by_layer in ends.items():
        if not by_layer:
            continue
        trunk, at = End(home), layer[home]
        last = max(by_layer) if way > 0 else min(by_layer)
        while at != last:
            following = list(by_layer.get(at + way, []))
            if at + way != last:
                rest = sum(w for k, each in by_layer.items() if (k - at - way) * way > 0 for _, w in each)
                spots.append(Spot(len(spots), at + way, PASS, PASS))
                following.append((End(len(spots) - 1), 1.0 + rest))
            others = [end for end, _ in following]
            sides = ([trunk], others) if way > 0 else (others, [trunk])
            yield NodeLines(node, min(at, at + way), trunk, *sides, dict(following))
            trunk, at = End(len(spots) - 1) if at + way != last else trunk, at + way
