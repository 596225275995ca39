"""Where the symbol of a shift element may stand on the grid, and the room that it takes with its name."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil

from clutchwork.diagrams.letters import width_of
from clutchwork.diagrams.stick.board import STEPS, Board
from clutchwork.diagrams.stick.bodies import Node
from clutchwork.diagrams.stick.search import Placer, ShiftSymbol

CELL = 12.0  # px from line to line
BELOW = 2  # rows from the housing down to where a symbol begins
NAME = 10.5  # px, size of names


def between_members(board: Board, name: str) -> Placer:
    """Symbols between two members: plates across a line, the name beside them."""
    across = _reach(name)
    long = ceil(width_of(name, NAME, bold=True) / CELL)

    def place(node: Node, way: int) -> Iterator[ShiftSymbol]:
        a, b = STEPS[way]
        middle, second = (node[0] + a, node[1] + b), (node[0] + 2 * a, node[1] + 2 * b)
        if not board.roomy(middle) or not board.inside(second) or second in board.solid:
            return
        x, y = middle
        for side in (1, -1):
            if way < 2:
                label = (x, y + 2 * side)
                words = [(x + n, y + 2 * side) for n in range(-across, across + 1)]
                plates = [(x, y + 1), (x, y - 1), (x + 1, y + side), (x - 1, y + side)]
            else:
                label = (x + 2 * side, y)
                words = [(x + n * side, y) for n in range(2, 2 + long)]
                plates = [(x + 1, y), (x - 1, y)]
            if all(board.roomy(cell) for cell in (*words, *plates)):
                yield ShiftSymbol(node, second, way, label, frozenset((middle, *words, *plates)))

    return place


def on_housing(board: Board, name: str) -> Placer:
    """Symbols below the housing, which is the uppermost row; the name stands above it."""
    across, top = _reach(name), board.rows - 1
    row = top - BELOW

    def place(node: Node, way: int) -> Iterator[ShiftSymbol]:
        if way != 2 or node[1] != row:
            return
        x = node[0]
        words = [(x + n, top) for n in range(-across, across + 1)]
        cells = frozenset((*words, (x, top - 1), (x - 1, top - 1), (x + 1, top - 1)))
        if all(board.roomy(cell) for cell in cells):
            yield ShiftSymbol(node, node, way, (x, top + 1), cells)

    return place


def below_housing(board: Board) -> list[Node]:
    """Nodes at which a symbol below the housing may begin."""
    return [(column, board.rows - 1 - BELOW) for column in range(board.columns)]


def _reach(name: str) -> int:
    """Columns that a name takes on either side of its middle."""
    return max(1, ceil((0.5 * width_of(name, NAME, bold=True) - 0.5 * CELL + 2.0) / CELL))
