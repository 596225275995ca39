"""Levers on the grid of a stick diagram: their points are rows of their own, at exact heights."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import ceil

from clutchwork.base import dataclass
from clutchwork.diagrams.letters import width_of
from clutchwork.diagrams.lever.heights import PITCH, Hung, hung
from clutchwork.diagrams.lever.points import levers
from clutchwork.diagrams.marks import SMALL
from clutchwork.diagrams.stick.bodies import Body, MemberPiece, Node
from clutchwork.diagrams.stick.improve import routed
from clutchwork.diagrams.stick.layout import Layout, laid, used
from clutchwork.diagrams.stick.route import NoRoomError, Router
from clutchwork.diagrams.stick.spots import CELL
from clutchwork.gearbox.definition import Definition

ENDS, BETWEEN, BELOW, ABOVE = 8, 7, 4, 9
MORE, TRIES = 3, 5


@dataclass(frozen=True, eq=False)
class Levers:
    """Levers at their places, and the lines between them."""

    hung: tuple[Hung, ...]
    plan: Layout


class _Structure:
    """What a layout depends on: not on gears."""

    def __init__(self, box: Definition, merged: bool) -> None:
        self.box, self.merged = box, merged
        self.key = repr((box.sets, box.elements, box.members, box.input, box.output, merged))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Structure) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)


def layout(box: Definition, *, merged: bool) -> Levers:
    """A lever for each set, or for those together that share two members; one that is known is not sought again."""
    return _laid(_Structure(box, merged))


@lru_cache(maxsize=32)
def _laid(structure: _Structure) -> Levers:
    box, merged = structure.box, structure.merged
    made = hung(levers(box.sets, merged=merged))
    for more in range(0, MORE * TRIES, MORE):
        rows = _rows(made, more)
        column, bodies = ENDS + more, list[Body]()
        for one in made:
            bodies.append(_body(one, rows, column))
            column += bodies[-1].width + 1 + BETWEEN + more
        router = routed(box, bodies, column - BETWEEN + ENDS, len(rows))
        if router is not None:
            return Levers(tuple(made), _plan(router, made, bodies, rows))
    raise NoRoomError


def _rows(made: Sequence[Hung], more: int) -> list[float]:
    """Heights of all points, and as many between them as there is room for [px]."""
    points = sorted({round(height, 4) for one in made for height in one.heights.values()})
    rows = [points[0] - CELL * n for n in range(BELOW + more, 0, -1)]
    for low, high in zip(points, [*points[1:], points[-1]], strict=True):
        count = max(1, int((high - low) / PITCH))
        rows += [low + (high - low) * n / count for n in range(count)]
    return [*rows, *(points[-1] + CELL * n for n in range(1, ABOVE + more))]


def _body(one: Hung, rows: Sequence[float], column: int) -> Body:
    """A lever with its ends on both sides, its words on the right."""
    words = max(width_of(one.lever.label(member), SMALL) for member in one.heights)
    width = 1 + max(2, ceil((words + 9.0) / CELL))
    places = {member: _row(rows, height) for member, height in one.heights.items()}
    pieces = {("", member): _piece(member, (column, row), width) for member, row in places.items()}
    made = Body("+".join(one.lever.sets), width, max(places.values()), pieces=pieces)
    low = min(places.values())
    made.solid.update((column + c, r) for c in range(width + 1) for r in range(low - 1, made.top + 2))
    made.solid.difference_update(end for piece in pieces.values() for end in piece.ends if piece.member != "housing")
    return made


def _row(rows: Sequence[float], height: float) -> int:
    return min(range(len(rows)), key=lambda number: abs(rows[number] - height))


def _piece(member: str, left: Node, width: int) -> MemberPiece:
    point, right = (left[0] + 1, left[1]), (left[0] + width, left[1])
    return MemberPiece(member, point, ((left, point), (point, right)), (left, right))


def _plan(router: Router, made: Sequence[Hung], bodies: Sequence[Body], rows: Sequence[float]) -> Layout:
    board = router.board
    columns, needed = used(router)
    roots = {
        source: body.pieces["", member].root
        for one, body in zip(made, bodies, strict=True)
        for member, ports in one.lever.ports.items()
        for source in ports
    }
    places = [CELL * sum(c in columns for c in range(number)) for number in range(board.columns)]
    # what stands on the housing comes right above the rest
    low, top = min(needed), max(needed - {board.rows - n for n in (1, 2, 3)})
    heights = [min(height, rows[top]) - rows[low] for height in rows]
    heights[-3:] = [heights[top] + CELL * n for n in (1, 2, 3)]
    return laid(router, bodies, roots, places, heights)
