"""What lies where on the grid of a stick diagram: lines of members, bodies, symbols; who may go where."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field
from itertools import pairwise

from clutchwork.base import dataclass
from clutchwork.diagrams.stick.bodies import Node

Edge = tuple[Node, Node]  # two neighbours, the lesser first
STEPS: tuple[Node, ...] = ((1, 0), (-1, 0), (0, 1), (0, -1))
CROSSING, NEAR = 14.0, 3.0
# directions of a line that goes along a row, and across it
ALONG, ACROSS = {0, 1}, {2, 3}


def edge(one: Node, other: Node) -> Edge:
    """The edge between two neighbours."""
    return (one, other) if one < other else (other, one)


def edges(one: Node, other: Node) -> list[Edge]:
    """The edges of a straight line."""
    (a, b), (c, d) = sorted((one, other))
    steps = max(c - a, d - b)
    nodes = [(a + (c > a) * n, b + (d > b) * n) for n in range(steps + 1)]
    return [edge(*pair) for pair in pairwise(nodes)]


@dataclass(frozen=True)
class Board:
    """The grid; lines are edges between neighbours, each of one member."""

    columns: int
    rows: int
    lines: dict[str, set[Edge]] = field(default_factory=dict)
    # member -> directions in which its lines leave a node
    at: dict[Node, dict[str, set[int]]] = field(default_factory=dict)
    solid: dict[Node, int] = field(default_factory=dict)
    ends: dict[Node, str] = field(default_factory=dict)
    near: dict[Node, set[str]] = field(default_factory=dict)

    def copy(self) -> Board:
        """The same once more."""
        return Board(
            self.columns,
            self.rows,
            {member: set(some) for member, some in self.lines.items()},
            {node: {member: set(ways) for member, ways in here.items()} for node, here in self.at.items()},
            dict(self.solid),
            dict(self.ends),
            {node: set(some) for node, some in self.near.items()},
        )

    def add(self, member: str, some: Iterable[Edge]) -> None:
        """Draw lines."""
        for one in some:
            self.lines.setdefault(member, set()).add(one)
            for node, way in _ways(one):
                self.at.setdefault(node, {}).setdefault(member, set()).add(way)

    def remove(self, member: str, some: Iterable[Edge]) -> None:
        """Take lines away."""
        for one in list(some):
            self.lines[member].discard(one)
            for node, way in _ways(one):
                here = self.at[node]
                here[member].discard(way)
                if not here[member]:
                    del here[member]
                if not here:
                    del self.at[node]

    def block(self, nodes: Iterable[Node]) -> None:
        """Nothing may go through these."""
        for node in nodes:
            self.solid[node] = self.solid.get(node, 0) + 1

    def unblock(self, nodes: Iterable[Node]) -> None:
        """Take that back."""
        for node in nodes:
            self.solid[node] -= 1
            if not self.solid[node]:
                del self.solid[node]

    def set_end(self, node: Node, member: str) -> None:
        """A place where others must not cross, and better keep clear of."""
        self.ends[node] = member
        for a, b in STEPS:
            self.near.setdefault((node[0] + a, node[1] + b), set()).add(member)

    def clear_end(self, node: Node, member: str) -> None:
        """Take that back."""
        del self.ends[node]
        for a, b in STEPS:
            self.near[node[0] + a, node[1] + b].discard(member)

    def nodes(self, member: str) -> set[Node]:
        """Where lines of a member may be joined: its nodes, less its crossings with others."""
        found = {node for one in self.lines.get(member, ()) for node in one if len(self.at[node]) == 1}
        return found | {node for node, owner in self.ends.items() if owner == member}

    def free(self, node: Node) -> bool:
        """Whether nothing is there."""
        return self.inside(node) and node not in self.solid and node not in self.at and node not in self.ends

    def roomy(self, node: Node) -> bool:
        """Whether a symbol may cover it: nothing is there, and no line needs it to get at an end that has none yet."""
        return self.free(node) and not self._bare(node)

    def _bare(self, node: Node) -> bool:
        """Whether an end beside it is joined by nothing but its own set."""
        for a, b in STEPS:
            end = (node[0] + a, node[1] + b)
            if end in self.ends and sum(map(len, self.at.get(end, {}).values())) < 2:
                return True
        return False

    def inside(self, node: Node) -> bool:
        """Whether it is on the grid."""
        return 0 <= node[0] < self.columns and 1 <= node[1] < self.rows

    def crossed(self, node: Node, member: str) -> bool:
        """Whether a line of another member lies there."""
        here = self.at.get(node)
        return here is not None and (len(here) > 1 or member not in here)

    def cost(self, node: Node, way: int, member: str) -> float | None:
        """What it costs to get there in a direction; None where one must not."""
        x, y = node
        if not (0 <= x < self.columns and 1 <= y < self.rows) or node in self.solid:
            return None
        if self.ends.get(node, member) != member:
            return None
        here = self.at.get(node)
        if here is not None and (len(here) > 1 or member not in here):
            # straight across one other line
            across = ACROSS if way < 2 else ALONG
            return CROSSING if len(here) == 1 and next(iter(here.values())) == across else None
        near = self.near.get(node)
        return NEAR if near and near != {member} else 0.0


def _ways(one: Edge) -> tuple[tuple[Node, int], tuple[Node, int]]:
    (a, _), (c, _) = one
    return ((one[0], 0), (one[1], 1)) if c > a else ((one[0], 2), (one[1], 3))
