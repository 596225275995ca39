"""Cheapest ways on the grid: between parts of a member, and through the symbol of a shift element to another member."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from heapq import heappop, heappush
from math import inf
from typing import NamedTuple

from clutchwork.base.classes import dataclass
from clutchwork.diagrams.stick.board import NEAR, STEPS, Board
from clutchwork.diagrams.stick.bodies import Node

BEND, JOIN = 3.0, 1.0
NO_WAY = -1  # direction at the begin
BACK = (1, 0, 3, 2)
MOST_BANNED = 12


class Symbol(NamedTuple):
    """A shift element on the grid: its ends, the cells that it covers, and where its name stands."""

    first: Node
    second: Node  # equal to the first where the housing is on the other side
    way: int  # direction from the first to the second end
    label: Node  # the middle of its name
    cells: frozenset[Node]

    @property
    def middle(self) -> Node:
        """Between its ends; of a brake the lining below the housing."""
        a, b = STEPS[self.way]
        return self.first[0] + a, self.first[1] + b


class Way(NamedTuple):
    """Nodes of a way, and the symbol between its first part and its second one."""

    cost: float
    before: tuple[Node, ...]
    after: tuple[Node, ...] = ()
    symbol: Symbol | None = None


class _State(NamedTuple):
    node: Node
    way: int
    symbol: Symbol | None


# symbols that may be placed from a node in a direction
Placer = Callable[[Node, int], Iterator[Symbol]]


@dataclass(frozen=True)
class Task:
    """A way that is sought: from one of some nodes to a goal, through one symbol where a placer is given.

    Parameters: members, before and behind the symbol; placer, symbols that may stand at a node; price, what a goal
    costs; limit, what a way may cost. Without goals a way ends behind its symbol.
    """

    members: tuple[str, str]
    starts: Collection[Node]
    goals: Collection[Node]
    placer: Placer | None = None
    price: Callable[[Node], float] | None = None
    limit: float = inf

    def ends(self, state: _State) -> bool:
        """Whether a way may end there."""
        if state.way == NO_WAY or (self.placer is not None and state.symbol is None):
            return False
        return state.node in self.goals if self.goals else state.symbol is not None


def find(board: Board, task: Task) -> Way | None:
    """The cheapest way; None: there is none."""
    banned, spots = set[Symbol](), dict[tuple[Node, int], list[Symbol]]()
    for _ in range(MOST_BANNED):
        found = _Search(board, task, banned, spots).run()
        if found is None or found.symbol is None or _clean(found, found.symbol):
            return found
        banned.add(found.symbol)
    return None


def _clean(way: Way, symbol: Symbol) -> bool:
    """Whether a way keeps clear of itself and of its own symbol."""
    nodes = [*way.before, *way.after]
    once = len(set(nodes)) == len(nodes) - (symbol.first == symbol.second)
    return once and not (set(nodes) - {symbol.first, symbol.second}) & symbol.cells


class _Search:
    """The method of Dijkstra over nodes, directions, and whether the symbol is placed."""

    def __init__(
        self, board: Board, task: Task, banned: set[Symbol], spots: dict[tuple[Node, int], list[Symbol]]
    ) -> None:
        self.board, self.task, self.banned, self.spots = board, task, banned, spots
        self.open: list[tuple[float, int, _State]] = []
        self.best: dict[tuple[Node, int, bool], float] = {}
        self.before: dict[_State, _State] = {}
        self.count = 0

    def run(self) -> Way | None:
        """The cheapest way."""
        for node in sorted(self.task.starts):
            self.push(0.0, _State(node, NO_WAY, None), None)
        while self.open:
            cost, _, state = heappop(self.open)
            if cost > self.best[state.node, state.way, state.symbol is not None]:
                continue
            if self.task.ends(state):
                return self.back(cost, state)
            for way in range(len(STEPS)):
                self.step(cost, state, way)
        return None

    def push(self, cost: float, state: _State, source: _State | None) -> None:
        """A state that may be reached at a cost."""
        key = (state.node, state.way, state.symbol is not None)
        if cost > self.task.limit or cost >= self.best.get(key, inf):
            return
        self.best[key] = cost
        if source is not None:
            self.before[state] = source
        self.count += 1
        heappush(self.open, (cost, self.count, state))

    def step(self, cost: float, state: _State, way: int) -> None:
        """One node on in a direction, or through a symbol."""
        straight = state.way in (way, NO_WAY)
        member = self.task.members[state.symbol is not None]
        crossing = self.board.crossed(state.node, member)
        fresh = state.symbol is not None and state.node == state.symbol.second
        if not straight and (crossing or fresh or state.way == BACK[way]):
            return
        node = (state.node[0] + STEPS[way][0], state.node[1] + STEPS[way][1])
        more = self.board.cost(node, way, member)
        if more is not None:
            more += 1.0 + (0.0 if straight else BEND) + (JOIN if state.way == NO_WAY else 0.0)
            more += self.task.price(node) if self.task.price is not None and node in self.task.goals else 0.0
            self.push(cost + more, _State(node, way, state.symbol), state)
        if self.task.placer is not None and state.symbol is None and straight and not crossing:
            key = (state.node, way)
            if key not in self.spots:
                self.spots[key] = [one for one in self.task.placer(state.node, way) if self.fits(one, way)]
            for symbol in self.spots[key]:
                if symbol not in self.banned:
                    self.push(cost + 2.0, _State(symbol.second, way, symbol), state)

    def fits(self, symbol: Symbol, way: int) -> bool:
        """Whether a symbol ends at the housing, on a free node or on the other member."""
        member = self.task.members[1]
        return symbol.second == symbol.first or self.board.cost(symbol.second, way, member) in (0.0, NEAR)

    def back(self, cost: float, state: _State) -> Way:
        """The way to a state."""
        nodes: list[list[Node]] = [[], []]
        now: _State | None = state
        while now is not None:
            nodes[now.symbol is not None].append(now.node)
            now = self.before.get(now)
        return Way(cost, tuple(reversed(nodes[0])), tuple(reversed(nodes[1])), state.symbol)
