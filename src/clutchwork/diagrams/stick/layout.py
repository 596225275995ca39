"""A gearbox laid out as a stick diagram: which order and side of its sets is best, and the grid without empty rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache

from clutchwork.base import dataclass
from clutchwork.diagrams.stick.board import Edge
from clutchwork.diagrams.stick.bodies import Body, Node, bodies
from clutchwork.diagrams.stick.improve import routed
from clutchwork.diagrams.stick.route import NoRoomError, Router
from clutchwork.diagrams.stick.search import ShiftSymbol
from clutchwork.diagrams.stick.spots import CELL
from clutchwork.gearbox.definition import Definition
from clutchwork.gearbox.gear_set import HOUSING

ENDS, BETWEEN, ABOVE = 8, 7, 9  # free columns at the ends and between sets, free rows above sets
MORE, TRIES = 4, 5


@dataclass(frozen=True, eq=False)
class Layout:
    """Bodies, lines by member and symbols on a grid, whose rows and columns stand at distances of their own."""

    bodies: tuple[Body, ...]
    lines: Mapping[str, frozenset[Edge]]
    symbols: Mapping[str, ShiftSymbol]
    gates: Mapping[str, Node]
    ends: Mapping[Node, str]  # whose line ends there: at sets, at symbols, at the edges
    roots: Mapping[tuple[str, str], Node]  # by set and port
    columns: Sequence[float]  # column of the grid -> its place in the picture [px]
    rows: Sequence[float]  # height above the centre line [px]
    wheels: Mapping[Node, int]  # 1 at suns, below their teeth, -1 at rings
    crossings: int
    cost: float


class _Structure:
    """What a layout depends on: not on teeth, and not on gears."""

    def __init__(self, box: Definition) -> None:
        self.box = box
        self.bodies = bodies(box.sets)
        self.key = repr((self.bodies, box.elements, box.members[:2]))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Structure) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)


def layout(box: Definition) -> Layout:
    """The best of a few arrangements; one that is known is not sought again."""
    return _best(_Structure(box))


@lru_cache(maxsize=32)
def _best(one: _Structure) -> Layout:
    """The cheapest over some orders in which elements are laid, then over both ways round of lopsided sets."""
    box, sides = one.box, [False] * len(one.bodies)
    orders = [box.elements, box.elements[::-1], tuple(sorted(box.elements, key=lambda e: HOUSING not in e.members))]
    boxes = [replace(box, elements=order) for order in dict.fromkeys(orders)]
    found = [(made, case) for case in boxes if (made := _routed(case, one.bodies, sides)) is not None]
    if not found:
        raise NoRoomError
    best, case = min(found, key=lambda pair: pair[0].cost)
    for number, drawn in enumerate(one.bodies):
        if not drawn.lopsided:
            continue
        turned = [side != (place == number) for place, side in enumerate(sides)]
        made = _routed(case, one.bodies, turned)
        if made is not None and made.cost < best.cost:
            best, sides = made, turned
    return best


def _routed(box: Definition, bodies: Sequence[Body], mirrored: Sequence[bool]) -> Layout | None:
    for more in range(0, MORE * TRIES, MORE):
        column, placed = ENDS + more, []
        for one, turned in zip(bodies, mirrored, strict=True):
            placed.append(one.placed(column, mirrored=turned))
            column += one.width + 1 + BETWEEN + more
        rows = max(one.top for one in bodies) + 2 + ABOVE + more
        router = routed(box, placed, column - BETWEEN + ENDS, rows)
        if router is not None:
            return _made(router, placed)
    return None


def _made(router: Router, bodies: Sequence[Body]) -> Layout:
    columns, rows = used(router)
    rows.add(0)
    roots = {source: piece.root for one in bodies for source, piece in one.pieces.items()}
    return laid(router, bodies, roots, _places(columns, router.board.columns), _places(rows, router.board.rows))


def laid(
    router: Router,
    bodies: Sequence[Body],
    roots: Mapping[tuple[str, str], Node],
    columns: Sequence[float],
    rows: Sequence[float],
) -> Layout:
    """What a router made, with its columns and rows at their places [px]."""
    return Layout(
        bodies=tuple(bodies),
        lines={member: frozenset(some) for member, some in router.board.lines.items()},
        symbols=dict(router.symbols),
        gates=dict(router.gates),
        ends=dict(router.board.ends),
        roots=roots,
        columns=columns,
        rows=rows,
        wheels={bar.at: 1 if bar.up else -1 for one in bodies for bar in one.bars},
        crossings=router.crossings(),
        cost=router.cost(),
    )


def used(router: Router) -> tuple[set[int], set[int]]:
    """Columns and rows that hold more than lines that go straight through."""
    board = router.board
    nodes = {*board.solid, *board.ends}
    columns, rows = {c for c, _ in nodes}, {r for _, r in nodes}
    for some in board.lines.values():
        columns |= {a[0] for a, b in some if a[0] == b[0]}
        rows |= {a[1] for a, b in some if a[1] == b[1]}
    return columns, rows


def _places(used: set[int], count: int) -> list[float]:
    """Where each row comes to lie when those that are not used are left out [px]."""
    places, place = list[float](), 0
    for number in range(count):
        places.append(CELL * place)
        place += number in used
    return places
