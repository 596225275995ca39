"""Cheapest ways on the grid: between parts of a member, and through the symbol of a shift element to another member."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Iterator
from heapq import heappop, heappush
from math import inf
from typing import NamedTuple

from clutchwork.base import dataclass
from clutchwork.diagrams.stick.board import NEAR, STEPS, Board
from clutchwork.diagrams.stick.bodies import Node

BEND, JOIN = 3.0, 1.0
NO_WAY = -1  # direction at the begin
BACK = (1, 0, 3, 2)
MOST_BANNED = 12


class ShiftSymbol(NamedTuple):
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


class Route(NamedTuple):
    """Nodes of a way, and the symbol between its first part and its second one."""

    cost: float
    before: tuple[Node, ...]
    after: tuple[Node, ...] = ()
    symbol: ShiftSymbol | None = None


# node, direction, symbol that was placed
_State = tuple[Node, int, ShiftSymbol | None]
BEGIN = -1  # where a start was reached from

# symbols that may be placed from a node in a direction
Placer = Callable[[Node, int], Iterator[ShiftSymbol]]


@dataclass(frozen=True)
class Query:
    """A way that is sought: from one of some nodes to a goal, through one symbol where a placer is given.

    Parameters: members, before and behind the symbol; placer, symbols that may stand at a node; price, what a goal
    costs; limit, what a way may cost; toward, where symbols may stand where there are no goals. Without goals a way
    ends behind its symbol.
    """

    members: tuple[str, str]
    starts: Collection[Node]
    goals: Collection[Node]
    placer: Placer | None = None
    price: Callable[[Node], float] | None = None
    limit: float = inf
    toward: Collection[Node] = ()

    def ends(self, node: Node, way: int, symbol: ShiftSymbol | None) -> bool:
        """Whether a way may end there."""
        if way == NO_WAY or (self.placer is not None and symbol is None):
            return False
        return node in self.goals if self.goals else symbol is not None


def find(board: Board, task: Query) -> Route | None:
    """The cheapest way; None: there is none."""
    banned, spots = set[ShiftSymbol](), dict[tuple[Node, int], list[ShiftSymbol]]()
    least = _least(board, task) if task.limit < inf else {}
    for _ in range(MOST_BANNED):
        found = _RouteSearch(board, task, banned, spots, least).run()
        if found is None or found.symbol is None or _clean(found, found.symbol):
            return found
        banned.add(found.symbol)
    return None


def _least(board: Board, task: Query) -> dict[Node, float]:
    """The least that is left to pay at a node: steps to the nearest goal around what is solid."""
    made = dict.fromkeys(task.goals or task.toward, 0.0)
    queue = deque(made)
    while queue:
        x, y = queue.popleft()
        more = made[x, y] + 1.0
        for a, b in STEPS:
            node = (x + a, y + b)
            if node not in made:
                made[node] = more
                if board.inside(node) and node not in board.solid and board.ends.get(node, "") in ("", *task.members):
                    queue.append(node)
    return made


def _clean(way: Route, symbol: ShiftSymbol) -> bool:
    """Whether a way keeps clear of itself and of its own symbol."""
    nodes = [*way.before, *way.after]
    once = len(set(nodes)) == len(nodes) - (symbol.first == symbol.second)
    return once and not (set(nodes) - {symbol.first, symbol.second}) & symbol.cells


class _RouteSearch:
    """The method of Dijkstra over nodes, directions, and whether the symbol is placed; most time of a picture."""

    def __init__(
        self,
        board: Board,
        task: Query,
        banned: set[ShiftSymbol],
        spots: dict[tuple[Node, int], list[ShiftSymbol]],
        least: dict[Node, float],
    ) -> None:
        self.board, self.task, self.banned, self.spots, self.least = board, task, banned, spots, least
        self.open: list[tuple[float, int, _State]] = []
        self.best: dict[tuple[Node, int, bool], float] = {}
        # of each state in the order in which they were reached: where it was reached from
        self.reached: list[tuple[_State, int]] = []

    def run(self) -> Route | None:
        """The cheapest way."""
        for node in sorted(self.task.starts):
            self.push(0.0, (node, NO_WAY, None), BEGIN)
        best, ends = self.best, self.task.ends
        while self.open:
            cost, number, state = heappop(self.open)
            node, way, symbol = state
            if cost > best[node, way, symbol is not None]:
                continue
            if ends(node, way, symbol):
                return self.back(cost, number)
            self.step(cost, number, state)
        return None

    def push(self, cost: float, state: _State, source: int) -> None:
        """A state that may be reached at a cost."""
        node, way, symbol = state
        key = (node, way, symbol is not None)
        rest = self.least.get(node, inf) if self.least else 0.0
        if cost >= self.best.get(key, inf) or cost + rest > self.task.limit:
            return
        self.best[key] = cost
        heappush(self.open, (cost, len(self.reached), state))
        self.reached.append((state, source))

    def step(self, cost: float, number: int, state: _State) -> None:
        """One node on in every direction, or through a symbol."""
        task, board, push = self.task, self.board, self.push
        (x, y), before, symbol = state
        member = task.members[symbol is not None]
        crossing = board.crossed((x, y), member)
        # no bend where lines cross, nor at the end of a symbol
        bound = crossing or (symbol is not None and (x, y) == symbol.second)
        start = JOIN if before == NO_WAY else 0.0
        placer = None if symbol is not None or crossing else task.placer
        for way, (a, b) in enumerate(STEPS):
            straight = before in (way, NO_WAY)
            if not straight and (bound or before == BACK[way]):
                continue
            node = (x + a, y + b)
            more = board.cost(node, way, member)
            if more is not None:
                more += 1.0 + (0.0 if straight else BEND) + start
                if task.price is not None and node in task.goals:
                    more += task.price(node)
                push(cost + more, (node, way, symbol), number)
            if placer is not None and straight:
                for one in self.symbols(placer, (x, y), way):
                    if one not in self.banned:
                        push(cost + 2.0, (one.second, way, one), number)

    def symbols(self, placer: Placer, node: Node, way: int) -> list[ShiftSymbol]:
        """Symbols that may stand at a node."""
        key = (node, way)
        if key not in self.spots:
            self.spots[key] = [one for one in placer(node, way) if self.fits(one, way)]
        return self.spots[key]

    def fits(self, symbol: ShiftSymbol, way: int) -> bool:
        """Whether a symbol ends at the housing, on a free node or on the other member."""
        member = self.task.members[1]
        return symbol.second == symbol.first or self.board.cost(symbol.second, way, member) in (0.0, NEAR)

    def back(self, cost: float, number: int) -> Route:
        """The way to a state."""
        nodes: list[list[Node]] = [[], []]
        (_, _, last), _ = self.reached[number]
        while number != BEGIN:
            (node, _, symbol), number = self.reached[number]
            nodes[symbol is not None].append(node)
        return Route(cost, tuple(reversed(nodes[0])), tuple(reversed(nodes[1])), last)
