"""Which way power flows: from sources to loads, as a current through the same network would."""

from __future__ import annotations

from collections import deque
from contextlib import suppress
from dataclasses import field
from numbers import Real
from typing import Any

import numpy as np

from clutchwork.base import dataclass
from clutchwork.declare.schema import Role
from clutchwork.schematic.diagram import Thing, first_oil_port
from clutchwork.schematic.symbols.symbol import LEFT, RIGHT

TRUNK, BRANCH = 0.2, 0.8  # what being on the way from source to load weighs, and what the current at most


@dataclass(frozen=True, eq=False)
class Flow:
    """Sides of all elements, and how much of the way from source to load each of their lines carries."""

    sides: dict[int, dict[str, int]] = field(default_factory=dict)  # by identity of the element: port -> side
    weight: dict[tuple[int, str], float] = field(default_factory=dict)  # 0 to 1


def drives(element: Any) -> bool | None:
    """Whether an element at one shaft drives or loads it; None where it does neither, or has a mistake."""
    with suppress(Exception):
        made: bool | None = element.drives()
        return made
    return None


def flow(nodes: list[Thing], elements: list[Thing]) -> Flow:
    """The flow through one connected part of a diagram."""
    made = Flow()
    joins = [element for element in elements if len(element.nodes) > 1]
    single = [element for element in elements if len(element.nodes) == 1]
    sources, loads = _ends(nodes, single)
    network = _Network(nodes, joins)
    level, distance = network.solve(sources, loads)
    key = {id(t): (-round(level[k], 6), distance[k], k) for k, t in enumerate(network.things)}
    place = {id(thing): k for k, thing in enumerate(network.things)}
    for element in joins:
        made.sides[id(element)] = _sides(element, key)
        for port, node in element.pins.items():
            made.weight[id(element), port] = abs(level[place[id(node)]] - level[place[id(element)]])
    most = max(made.weight.values(), default=0.0) or 1.0
    trunk = {(id(one), id(two)) for one, two in network.trunk(loads, distance)}
    for element in joins:
        for port, node in element.pins.items():
            on_trunk = (id(element), id(node)) in trunk
            made.weight[id(element), port] = TRUNK * on_trunk + BRANCH * made.weight[id(element), port] / most
    driving = {id(node) for node in sources}
    for element in single:
        node = element.nodes[0]
        first = element.what == "heat" or drives(element.source) is True
        first |= drives(element.source) is False and id(node) in driving and element.source.role is not Role.CONTACT
        # oil that comes out of the sump
        first |= node.what == "oil" and first_oil_port(element.source) not in element.pins
        made.sides[id(element)] = dict.fromkeys(element.pins, RIGHT if first else LEFT)
    return made


def _ends(nodes: list[Thing], single: list[Thing]) -> tuple[list[Thing], list[Thing]]:
    """Nodes that are driven, and nodes that are only loaded."""
    driven = dict.fromkeys(e.nodes[0] for e in single if e.what == "heat" or drives(e.source) is True)
    loaded = dict.fromkeys(e.nodes[0] for e in single if e.what != "heat" and drives(e.source) is False)
    loaded.update(dict.fromkeys(node for node in nodes if node.what == "ambient"))
    sources = list(driven) or [max(nodes, key=_speed)]
    return sources, [node for node in loaded if node not in sources]


def _speed(node: Thing) -> float:
    speed = getattr(node.source, "speed", None)
    return abs(float(speed)) if isinstance(speed, Real) else 0.0


def _sides(element: Thing, key: dict[int, tuple[float, int, int]]) -> dict[str, int]:
    """Ports on the left where what is attached comes before the element; one at least on either side."""
    ordered = sorted(element.nodes, key=lambda node: key[id(node)])
    before = sum(key[id(node)] < key[id(element)] for node in ordered)
    before = min(max(before, 1), len(ordered) - 1)
    first = {id(node) for node in ordered[:before]}
    return {port: LEFT if id(node) in first else RIGHT for port, node in element.pins.items()}


class _Network:
    """Nodes and the elements between them, each line a resistance of one."""

    def __init__(self, nodes: list[Thing], joins: list[Thing]) -> None:
        self.things = [*nodes, *joins]
        place = {id(thing): k for k, thing in enumerate(self.things)}
        self.next: list[list[int]] = [[] for _ in self.things]
        for element in joins:
            for node in element.nodes:
                self.next[place[id(element)]].append(place[id(node)])
                self.next[place[id(node)]].append(place[id(element)])

    def solve(self, sources: list[Thing], loads: list[Thing]) -> tuple[list[float], list[int]]:
        """Potential, 1 at the sources and 0 at the loads, and steps from the sources, of every thing."""
        place = {id(thing): k for k, thing in enumerate(self.things)}
        starts = [place[id(node)] for node in sources]
        distance = self._distances(starts)
        stops = [place[id(node)] for node in loads]
        # a generator near the engine is not what the driveline is for
        most = max((distance[k] for k in stops), default=0)
        stops = [k for k in stops if 2 * distance[k] >= most]
        if not stops:
            # the far end, nodes before elements
            far = max(range(len(self.things)), key=lambda k: (self.things[k].is_node, distance[k], k))
            stops = [far] if far not in starts else []
        level = np.ones(len(self.things))
        if stops:
            level = self._potential(starts, stops)
        return [float(value) for value in level], distance

    def trunk(self, loads: list[Thing], distance: list[int]) -> list[tuple[Thing, Thing]]:
        """The shortest way from the sources to the load that is farthest, as pairs of an element and a node."""
        place = {id(thing): k for k, thing in enumerate(self.things)}
        ends = [place[id(node)] for node in loads] or [k for k, thing in enumerate(self.things) if thing.is_node]
        here, found = max(ends, key=lambda k: (distance[k], -k)), list[tuple[Thing, Thing]]()
        while distance[here] > 0:
            nearer = [k for k in self.next[here] if distance[k] == distance[here] - 1]
            # a clutch before a set of gears beside it
            before = min(nearer, key=lambda k: (not self.things[k].is_node and len(self.next[k]) > 2, k))
            pair = (self.things[here], self.things[before])
            found.append(pair if pair[1].is_node else pair[::-1])
            here = before
        return found

    def _distances(self, starts: list[int]) -> list[int]:
        found = [-1] * len(self.things)
        for start in starts:
            found[start] = 0
        todo = deque(starts)
        while todo:
            here = todo.popleft()
            for other in self.next[here]:
                if found[other] < 0:
                    found[other] = found[here] + 1
                    todo.append(other)
        return found

    def _potential(self, starts: list[int], stops: list[int]) -> Any:
        size = len(self.things)
        matrix, right = np.zeros((size, size)), np.zeros(size)
        for k, others in enumerate(self.next):
            if k in starts or k in stops:
                matrix[k, k], right[k] = 1.0, float(k in starts)
                continue
            matrix[k, k] = max(len(others), 1)
            for other in others:
                matrix[k, other] -= 1.0
        return np.linalg.solve(matrix, right)
