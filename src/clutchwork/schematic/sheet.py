"""The whole picture as marks: every connected part laid out by itself, the parts one below the other."""

from __future__ import annotations

from dataclasses import field
from itertools import pairwise
from math import ceil

from clutchwork.base import dataclass
from clutchwork.schematic.cells import SymbolCell, cell_of, line_of
from clutchwork.schematic.diagram import SymbolGraph, Thing
from clutchwork.schematic.flow import flow
from clutchwork.schematic.layers import Layers, layered
from clutchwork.schematic.look import MarkStyle
from clutchwork.schematic.moment import Snapshot
from clutchwork.schematic.order import ordered
from clutchwork.schematic.pen import Mark, Point, Rect, Stroke, around
from clutchwork.schematic.places import Coordinates, placed

APART, WIDEST, BEND = 20.0, 520.0, 10.0  # pt between parts, and of a row of small ones
DOT = 1.7
WIDE = 880.0  # pt


def folds(layers: Layers, places: Coordinates, width: float = WIDE) -> list[int]:
    """First layers of the second row and those behind; none where all fits, or nothing can be cut."""
    first, last = places.x[0], places.x[-1]
    count = ceil((last - first) / width) if width > 0.0 else 1
    can = [layer for layer in range(2, layers.count - 1) if _single(layers, layer)]
    cuts = list[int]()
    for number in range(1, count):
        wanted = first + (last - first) * number / count
        free = [layer for layer in can if layer > (cuts[-1] + 1 if cuts else 1)]
        if not free:
            break
        cuts.append(min(free, key=lambda layer: abs(0.5 * (places.x[layer - 1] + places.x[layer]) - wanted)))
    return cuts


def _single(layers: Layers, layer: int) -> bool:
    """Whether only one line goes into a layer."""
    lines = [one for one in layers.lines if one.layer == layer - 1]
    return len(lines) == 1 and len(lines[0].left) == len(lines[0].right) == 1


@dataclass(frozen=True, eq=False)
class Wired:
    """The lines of one node: points joined by straight pieces."""

    node: str
    look: MarkStyle
    pieces: list[tuple[Point, Point]]
    dots: list[Point]


@dataclass(frozen=True, eq=False)
class Sheet:
    """Pieces at their places, lines, and what they cover together [pt]."""

    pieces: list[SymbolCell] = field(default_factory=list)
    wires: list[Wired] = field(default_factory=list)
    links: list[Mark] = field(default_factory=list)

    @property
    def marks(self) -> list[Mark]:
        """All marks, lines first."""
        lines: list[Mark] = [Stroke(piece, False, wire.look) for wire in self.wires for piece in wire.pieces]
        symbols = [mark for piece in self.pieces for mark in (*piece.marks, *piece.text)]
        return [*lines, *self.links, *symbols]

    @property
    def box(self) -> Rect:
        """What is covered."""
        marks = self.marks
        return around(marks) if marks else Rect(0.0, 0.0, 0.0, 0.0)

    def moved(self, x: float, y: float) -> Sheet:
        """The same elsewhere."""

        def to(point: Point) -> Point:
            return point[0] + x, point[1] + y

        return Sheet(
            [
                SymbolCell(p.name, p.what, [m.moved(x, y) for m in p.marks], [t.moved(x, y) for t in p.text])
                for p in self.pieces
            ],
            [
                Wired(w.node, w.look, [(to(a), to(b)) for a, b in w.pieces], [to(dot) for dot in w.dots])
                for w in self.wires
            ],
            [mark.moved(x, y) for mark in self.links],
        )

    def add(self, other: Sheet) -> None:
        """Take what another sheet has."""
        self.pieces.extend(other.pieces)
        self.wires.extend(other.wires)
        self.links.extend(other.links)


def sheet(diagram: SymbolGraph, moment: Snapshot, *, values: bool = True, width: float = WIDE) -> Sheet:
    """Lay out a diagram; what is wider than `width` [pt] is folded where it can be."""
    parts = [_part(things, moment, values, width) for things in _connected(diagram)]
    made, top = Sheet(), 0.0
    for row in _rows(parts):
        left, low = 0.0, top
        for part in row:
            box = part.box
            moved = part.moved(left - box.left, top - box.high)
            made.add(moved)
            low = min(low, top - (box.high - box.low))
            left += box.right - box.left + APART
        top = low - APART
    return made


def _rows(parts: list[Sheet]) -> list[list[Sheet]]:
    """Parts in rows no wider than the widest of them."""
    widths = [part.box.right - part.box.left for part in parts]
    most, rows, used = max([WIDEST, *widths]), list[list[Sheet]](), 0.0
    for part, width in zip(parts, widths, strict=True):
        if not rows or used + width > most:
            rows.append([])
            used = 0.0
        rows[-1].append(part)
        used += width + APART
    return rows


def _connected(diagram: SymbolGraph) -> list[list[Thing]]:
    """Things that hang together, mechanical ones first."""
    group = {id(thing): number for number, thing in enumerate(diagram.things)}
    members = {number: [thing] for number, thing in enumerate(diagram.things)}
    for element in diagram.elements:
        for node in element.nodes:
            one, two = group[id(element)], group[id(node)]
            if one != two:
                one, two = min(one, two), max(one, two)
                for thing in members[two]:
                    group[id(thing)] = one
                members[one] += members.pop(two)
    kinds = {"shaft": 0, "mass": 0, "missing": 0, "thermal": 1, "ambient": 1}
    found = [sorted(things, key=lambda thing: diagram.things.index(thing)) for things in members.values()]
    return sorted(found, key=lambda things: min(kinds.get(thing.what, 2) for thing in things))


def _part(things: list[Thing], moment: Snapshot, values: bool, width: float) -> Sheet:
    nodes = [thing for thing in things if thing.is_node]
    elements = [thing for thing in things if not thing.is_node]
    way = flow(nodes, elements) if nodes else None
    cells = [cell_of(thing, way.sides.get(id(thing), {}) if way else {}, moment, values=values) for thing in things]
    made = Sheet()
    if way is None:
        for cell in cells:
            made.pieces.extend(_moved(piece, x, y) for piece, x, y in cell.pieces)
            made.links.extend(cell.links)
        return made
    layers = layered(cells, way)
    places = placed(layers, ordered(layers))
    cuts = folds(layers, places, width)
    rows = [_row(layers, places, first, last) for first, last in zip([0, *cuts], [*cuts, layers.count], strict=True)]
    return _stacked(rows, [_crossing(places, cut) for cut in cuts])


def _row(layers: Layers, places: Coordinates, first: int, last: int) -> Sheet:
    """The layers from `first` up to `last`, without the lines to those behind."""
    made = Sheet()
    for spot in layers.spots:
        if spot.cell is not None and first <= spot.layer < last:
            x, y = places.x[spot.layer], places.y[spot.number]
            made.pieces.extend(_moved(piece, x + a, y + b) for piece, a, b in spot.cell.pieces)
            made.links.extend(mark.moved(x, y) for mark in spot.cell.links)
    made.wires.extend(
        Wired(wire.lines.node.name, line_of(wire.lines.node), wire.pieces, wire.dots)
        for wire in places.wires
        if first <= wire.lines.layer < last - 1
    )
    return made


def _crossing(places: Coordinates, cut: int) -> tuple[Thing, Point, Point]:
    """The only line behind a layer: its node, where it leaves and where it goes on."""
    wire = next(wire for wire in places.wires if wire.lines.layer == cut - 1)
    return wire.lines.node, wire.pins[0], wire.pins[-1]


def _stacked(rows: list[Sheet], crossings: list[tuple[Thing, Point, Point]]) -> Sheet:
    """Rows one below the other, each joined to the next by a line around its end."""
    made, shift = Sheet(), [(0.0, 0.0)]
    edge = max((row.box.right - row.box.left for row in rows), default=0.0) + BEND
    for number, row in enumerate(rows):
        box = row.box
        if number:
            before = rows[number - 1].box.low + shift[-1][1]
            shift.append((rows[0].box.left - box.left, before - 2.0 * BEND - box.high))
        made.add(row.moved(*shift[-1]))
    for number, (node, leaves, goes_on) in enumerate(crossings):
        (a, b), (c, d) = shift[number], shift[number + 1]
        start, end = (leaves[0] + a, leaves[1] + b), (goes_on[0] + c, goes_on[1] + d)
        right, left = rows[0].box.left + edge, rows[0].box.left - BEND
        between = rows[number].box.low + b - BEND
        way = [start, (right, start[1]), (right, between), (left, between), (left, end[1]), end]
        made.wires.append(Wired(node.name, line_of(node), list(pairwise(way)), []))
    return made


def _moved(piece: SymbolCell, x: float, y: float) -> SymbolCell:
    return SymbolCell(
        piece.name, piece.what, [mark.moved(x, y) for mark in piece.marks], [text.moved(x, y) for text in piece.text]
    )
