"""The lines of a diagram: members joined, shift elements placed with lines to both sides."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import inf

from clutchwork.diagrams.stick.board import CROSSING, Board, Edge, edge, edges
from clutchwork.diagrams.stick.bodies import Body, MemberPiece, Node
from clutchwork.diagrams.stick.search import BEND, Query, Route, ShiftSymbol, find
from clutchwork.diagrams.stick.spots import below_housing, between_members, on_housing
from clutchwork.gearbox.definition import Definition, ShiftElement
from clutchwork.gearbox.gear_set import HOUSING

IN, OUT = "input", "output"
HIGHER = 0.4  # what a row costs input and output


class NoRoomError(Exception):
    """The grid is too small, or others are in the way of a shift element."""


class Router:
    """Lays the lines of a gearbox onto a board whose bodies have their places."""

    def __init__(self, box: Definition, bodies: Sequence[Body], board: Board) -> None:
        self.box = box
        self.board = board
        self.symbols: dict[str, ShiftSymbol] = {}
        self.gates: dict[str, Node] = {}
        self.limit = inf  # what a way may cost
        self.fixed: dict[str, set[Edge]] = {member: set() for member in box.members}
        self.pieces = [piece for one in bodies for piece in one.pieces.values() if piece.member != HOUSING]
        for one in bodies:
            board.block(one.solid)
        for piece in self.pieces:
            some = [part for line in piece.lines for part in edges(*line)]
            self.fixed[piece.member].update(some)
            board.add(piece.member, some)
            for end in piece.ends:
                board.set_end(end, piece.member)

    def run(self, urgent: Sequence[str] = ()) -> None:
        """Lay all lines, elements that are urgent before the others."""
        for member in self.order():
            self.join(member)
        for name in (IN, OUT):
            self.open_gate(name)
        rank = {name: place for place, name in enumerate(urgent)}
        left = sorted(self.box.elements, key=lambda element: rank.get(element.name, len(rank)))
        while left:
            ready = [one for one in left if self._reachable(one)]
            if not ready:
                self._seed(left[0])
                continue
            self.place(ready[0])
            left.remove(ready[0])

    def cost(self) -> float:
        """Lengths, bends and crossings of all lines."""
        length = sum(map(len, self.board.lines.values()))
        total = float(length)
        for here in self.board.at.values():
            total += CROSSING * (len(here) - 1)
            total += BEND * sum(not ways <= {0, 1} and not ways <= {2, 3} for ways in here.values())
        return total + HIGHER * sum(row for _, row in self.gates.values())

    def crossings(self) -> int:
        """How many lines cross."""
        return sum(len(here) > 1 for here in self.board.at.values())

    def order(self) -> list[str]:
        """Members with short ways first."""
        columns: dict[str, list[int]] = {member: [] for member in self.box.members}
        for piece in self.pieces:
            columns[piece.member].append(piece.root[0])
        return sorted(columns, key=lambda m: (max(columns[m], default=0) - min(columns[m], default=0), m))

    # members

    def _parts(self, member: str) -> list[set[Node]]:
        """Nodes of a member that hang together."""
        parts = [
            {node for one in pairwise_nodes(piece) for node in one} for piece in self.pieces if piece.member == member
        ]
        parts += [{node} for node, owner in self.board.ends.items() if owner == member]
        made: list[set[Node]] = []
        for part in [*parts, *({*one} for one in sorted(self.board.lines.get(member, ())))]:
            touching = [other for other in made if other & part]
            made = [other for other in made if not other & part]
            made.append(part.union(*touching))
        return made

    def strip(self, member: str) -> None:
        """Take away all lines of a member but those in its sets."""
        self.board.remove(member, self.board.lines.get(member, set()) - self.fixed[member])

    def join(self, member: str) -> None:
        """Lines between all parts of a member."""
        parts = self._parts(member)
        while len(parts) > 1:
            joinable = self.board.nodes(member)
            ways = find(
                self.board,
                Query((member, member), parts[0] & joinable, set().union(*parts[1:]) & joinable, limit=self.limit),
            )
            if ways is None:
                raise NoRoomError
            self._draw(member, ways.before)
            parts = self._parts(member)

    def _draw(self, member: str, nodes: Sequence[Node]) -> None:
        self.board.add(member, [edge(*pair) for pair in pairwise(nodes)])

    def _prune(self, member: str) -> list[Edge]:
        """Take away lines that lead nowhere."""
        gone: list[Edge] = []
        while True:
            leaves = [
                one for one in self.board.lines.get(member, ())
                if one not in self.fixed[member] and any(self._loose(node, member) for node in one)
            ]  # fmt: skip
            if not leaves:
                return gone
            self.board.remove(member, leaves)
            gone += leaves

    def _loose(self, node: Node, member: str) -> bool:
        return len(self.board.at[node][member]) == 1 and self.board.ends.get(node) != member

    # input and output

    def open_gate(self, name: str) -> None:
        """The way of the input to the left edge, of the output to the right one."""
        member = self.box.input if name == IN else self.box.output
        column = 0 if name == IN else self.board.columns - 1
        goals = [(column, row) for row in range(1, self.board.rows - 3) if self.board.free((column, row))]
        nodes = self.board.nodes(member)
        if nodes:
            way = find(
                self.board,
                Query((member, member), nodes, set(goals), price=lambda node: HIGHER * node[1], limit=self.limit),
            )
            if way is None:
                raise NoRoomError
            self._draw(member, way.before)
            goals = [way.before[-1]]
        self.gates[name] = goals[0]
        self.board.set_end(self.gates[name], member)

    def close_gate(self, name: str) -> None:
        """Take that back."""
        member = self.box.input if name == IN else self.box.output
        self.board.clear_end(self.gates.pop(name), member)
        self._prune(member)

    # shift elements

    def _reachable(self, element: ShiftElement) -> bool:
        known = [m for m in element.members if m != HOUSING and self.board.nodes(m)]
        return bool(known)

    def _seed(self, element: ShiftElement) -> None:
        """A node of a member that has none yet."""
        member = next(m for m in element.members if m != HOUSING)
        spots = [(c, r) for r in range(1, self.board.rows - 4) for c in range(2, self.board.columns - 2)]
        spot = next((node for node in spots if self.board.free(node)), None)
        if spot is None:
            raise NoRoomError
        self.board.set_end(spot, member)

    def place(self, element: ShiftElement) -> None:
        """The symbol of an element, and lines to both its members."""
        first, second = sorted(element.members, key=lambda m: (m == HOUSING, not self.board.nodes(m)))
        if second == HOUSING:
            placer, goals = on_housing(self.board, element.name), set[Node]()
            toward = below_housing(self.board)
        else:
            toward = []
            placer, goals = between_members(self.board, element.name), self.board.nodes(second)
        way = find(
            self.board, Query((first, second), self.board.nodes(first), goals, placer, limit=self.limit, toward=toward)
        )
        if way is None or way.symbol is None:
            raise NoRoomError(element.name)
        self._put(element, first, second, way, way.symbol)

    def _put(self, element: ShiftElement, first: str, second: str, way: Route, symbol: ShiftSymbol) -> None:
        self._draw(first, way.before)
        self.board.set_end(symbol.first, first)
        if second != HOUSING:
            self._draw(second, way.after)
            self.board.set_end(symbol.second, second)
        self.board.block(symbol.cells)
        self.symbols[element.name] = symbol

    def lift(self, element: ShiftElement) -> None:
        """Take an element off the board, with the lines that led to it alone."""
        symbol = self.symbols.pop(element.name)
        self.board.unblock(symbol.cells)
        for node in {symbol.first, symbol.second}:
            self.board.clear_end(node, self.board.ends[node])
        for member in element.members:
            if member != HOUSING:
                self._prune(member)


def pairwise_nodes(piece: MemberPiece) -> list[Edge]:
    """The edges of all lines of a piece."""
    return [part for line in piece.lines for part in edges(*line)]
