"""A cell: the symbol of a thing with its text, as one block that nothing else may cover."""

from __future__ import annotations

from collections.abc import Mapping

from clutchwork.base import dataclass
from clutchwork.schematic.diagram import Thing
from clutchwork.schematic.look import (
    BODY,
    GREY,
    HEAT,
    INK,
    LINE,
    MASS,
    NAME,
    OIL,
    SHAFT,
    SIGNAL,
    VALUE,
    WARM,
    WRONG,
    MarkStyle,
)
from clutchwork.schematic.moment import Snapshot
from clutchwork.schematic.pen import Mark, Rect, SymbolPen, Text, around
from clutchwork.schematic.symbols.heat import AMBIENT, CAPACITY, SOURCE
from clutchwork.schematic.symbols.symbol import LEFT, RIGHT, Drawn, Symbol
from clutchwork.schematic.symbols.table import symbol_of
from clutchwork.schematic.values import element_values, node_values

GAP = 2.6  # pt between a symbol and its text
APART = 8.0  # pt between helpers
NOW = "#00497A"  # numbers of a run


@dataclass(frozen=True, eq=False)
class SymbolCell:
    """One symbol with its marks and text, about an origin."""

    name: str
    what: str
    marks: list[Mark]  # the symbol
    text: list[Text]


@dataclass(frozen=True, eq=False)
class Cell:
    """A thing and its helpers, about the middle of the symbol of the thing."""

    thing: Thing
    pieces: list[tuple[SymbolCell, float, float]]
    links: list[Mark]  # lines within the cell
    box: Rect
    half: float  # pt from the middle to its pins
    pins: Mapping[str, tuple[int, float]]  # port -> side and height; a node has none, its lines end at 0


def line_of(node: Thing) -> MarkStyle:
    """The look of what is attached to a node."""
    if node.what in ("thermal", "ambient", "element"):
        return HEAT
    if node.what == "oil" or getattr(node.source, "gathers", False):
        return OIL
    if node.what == "mass":
        return MASS
    heat = node.what == "missing" and type(node.source).__name__ == "ThermalNode"
    return HEAT if heat else SHAFT


def cell_of(thing: Thing, sides: Mapping[str, int], moment: Snapshot, *, values: bool = True) -> Cell:
    """The cell of a node or of an element whose ports are on the given sides."""
    if thing.is_node:
        return _node_cell(thing, moment, values)
    return _element_cell(thing, sides, moment, values)


def _node_cell(thing: Thing, moment: Snapshot, values: bool) -> Cell:
    pen, source = SymbolPen(), thing.source
    half = 7.0
    if thing.what in ("thermal", "ambient", "oil"):
        symbol = symbol_of(source) if hasattr(source, "kind") else AMBIENT if thing.what == "ambient" else CAPACITY
        symbol.draw(pen, Drawn(source, {}, half=symbol.half))
        half = symbol.half
    elif thing.what == "missing":
        half = 9.0
        pen.box(-6.0, -9.0, 6.0, 9.0, look=WRONG)
        pen.text(0.0, -3.4, "?", 9.5, WRONG.colour, bold=True)
    elif thing.what == "mass":
        half = 15.0
        pen.line((-half, 0.0), (half, 0.0), look=MASS)
        pen.box(-11.0, -9.0, 11.0, 9.0, look=MarkStyle(MASS.colour, 1.2, "#DCEBE5"))
    else:
        pen.line((-half, 0.0), (half, 0.0), look=SHAFT)
        if getattr(source, "inertia", 0.0):
            pen.box(-3.6, -13.0, 3.6, 13.0, look=BODY._replace(width=1.2))
        else:
            pen.circle(0.0, 0.0, 1.9, look=INK._replace(fill=INK.colour))
    lines = node_values(thing) if values or thing.what == "missing" else []
    colour = WRONG.colour if thing.what == "missing" else WARM.colour if line_of(thing) is HEAT else GREY
    piece = _labelled(thing, pen.marks, lines, moment.node_lines(thing), colour, below=False)
    marks: list[Mark] = [*piece.marks, *piece.text]
    return Cell(thing, [(piece, 0.0, 0.0)], [], around(marks), half, {})


def _element_cell(thing: Thing, sides: Mapping[str, int], moment: Snapshot, values: bool) -> Cell:
    symbol = SOURCE if thing.what == "heat" else symbol_of(thing.source)
    mirrored = _mirrored(thing, sides, symbol)
    heights = {port: symbol.heights(thing.source).get(port, 0.0) for port in (*thing.pins, *thing.fixed)}
    heights |= {port: -symbol.down - 6.0 * (number + 1) for number, port in enumerate(thing.inner)}
    pen = SymbolPen(mirrored=mirrored)
    if thing.what == "heat":
        shown = Drawn(thing.source, _flip(sides, mirrored), half=symbol.half)
        symbol.draw(pen, shown)
        piece = _labelled(thing, pen.marks, [], [], WARM.colour, below=False, prefix="heat of ")
    else:
        for port in thing.inner:
            side = _flip(sides, mirrored)[port]
            pen.line((0.0, -symbol.down), (0.0, heights[port]), (side * symbol.half, heights[port]), look=SHAFT)
        own = {port: side for port, side in sides.items() if port not in thing.inner and "." not in port}
        piece = _element_piece(thing, pen, symbol, _flip(own, mirrored), heights, moment, values)
    made, links = [(piece, 0.0, 0.0)], list[Mark]()
    if thing.helpers:
        _add_helpers(thing, symbol.up, 0.0, made, links, moment, values, sides)
        _pipe(thing, sides, symbol.half, made, links, heights)
    marks = [mark.moved(x, y) for one, x, y in made for mark in (*one.marks, *one.text)]
    pins = {port: (sides[port], heights.get(port, 0.0)) for port in thing.pins}
    return Cell(thing, made, links, around([*marks, *links]), symbol.half, pins)


def _element_piece(
    thing: Thing,
    pen: SymbolPen,
    symbol: Symbol,
    sides: Mapping[str, int],
    heights: Mapping[str, float],
    moment: Snapshot,
    values: bool,
) -> SymbolCell:
    nodes = list(thing.pins.values())
    line = line_of(nodes[0]) if nodes else SHAFT
    shown = Drawn(
        thing.source, sides, thing.fixed, moment.state(thing), line, moment.parts(thing), symbol.half, heights
    )
    symbol.draw(pen, shown)
    now = moment.element_lines(thing)
    # of a run its numbers are enough
    lines = element_values(thing) if values and not now and not shown.state else []
    return _labelled(thing, pen.marks, lines, now, GREY, below=bool(thing.helpers))


def _mirrored(thing: Thing, sides: Mapping[str, int], symbol: Symbol) -> bool:
    """Whether the first port, which a symbol has on its left, is on the right."""
    if symbol.pins:
        return False
    ports = [*thing.pins, *thing.fixed] if len(thing.pins) == 1 else list(thing.pins)
    declared = _in_order(thing, ports)
    for place, port in enumerate(declared):
        if port in sides:
            return sides[port] == (RIGHT if place == 0 else LEFT)
    return False


def _in_order(thing: Thing, ports: list[str]) -> list[str]:
    names = list(getattr(type(thing.source), "__dataclass_fields__", ()))
    return sorted(ports, key=lambda port: names.index(port) if port in names else len(names))


def _flip(sides: Mapping[str, int], mirrored: bool) -> dict[str, int]:
    return {port: -side if mirrored else side for port, side in sides.items()}


def _add_helpers(
    thing: Thing,
    top: float,
    x: float,
    made: list[tuple[SymbolCell, float, float]],
    links: list[Mark],
    moment: Snapshot,
    values: bool,
    sides: Mapping[str, int],
) -> None:
    """Processes above what they drive, side by side, each with a dotted line to it."""
    # a piston stands where its line comes from
    order = sorted(thing.helpers, key=lambda one: sum(sides.get(f"{one.name}.{port}", 0) for port in one.pins))
    pieces = [(helper, _helper_piece(helper, moment, values)) for helper in order]
    boxes = [around([*piece.marks, *piece.text]) for _, piece in pieces]
    wide = sum(box.right - box.left for box in boxes) + APART * (len(boxes) - 1)
    left, pen = x - wide / 2, SymbolPen()
    for (helper, piece), box in zip(pieces, boxes, strict=True):
        symbol = around(piece.marks)
        at = (left - box.left, top + 12.0 - symbol.low)
        left += box.right - box.left + APART
        made.append((piece, *at))
        corner = () if abs(at[0] - x) < 1e-6 else ((at[0], top + 7.0), (x, top + 7.0))
        pen.line((at[0], at[1] + symbol.low), *corner, (x, top + 2.0), look=SIGNAL)
        pen.arrow((x, top), (0.0, -1.0), 3.2, look=SIGNAL._replace(dash="solid"))
        if helper.helpers:
            # above the text of this one
            inner = list[Mark]()
            _add_helpers(helper, at[1] + box.high + 2.0, at[0], made, inner, moment, values, {})
            links += inner
    links += pen.marks


def _pipe(
    thing: Thing,
    sides: Mapping[str, int],
    half: float,
    made: list[tuple[SymbolCell, float, float]],
    links: list[Mark],
    heights: dict[str, float],
) -> None:
    """The line of oil to a piston above what it presses."""
    for helper in thing.helpers:
        for port in helper.pins:
            name, pen = f"{helper.name}.{port}", SymbolPen()
            x, y = next((x, y) for piece, x, y in made if piece.name == helper.name)
            heights[name] = y
            pen.line((x + sides[name] * (symbol_of(helper.source).half - 1.0), y), (sides[name] * half, y), look=OIL)
            links += pen.marks


def _helper_piece(helper: Thing, moment: Snapshot, values: bool) -> SymbolCell:
    """A process with all its text above it."""
    symbol, pen = symbol_of(helper.source), SymbolPen()
    symbol.draw(pen, Drawn(helper.source, {}, half=symbol.half))
    now = moment.element_lines(helper)
    lines = element_values(helper) if values and not now else []
    texts, y = list[Text](), around(pen.marks).high + GAP + 0.24 * VALUE
    for line in reversed([*lines, *now]):
        texts.append(Text(0.0, y, line, VALUE, NOW if line in now else GREY, False))
        y += LINE
    texts.append(Text(0.0, y, helper.name, NAME, INK.colour, True))
    return SymbolCell(helper.name, helper.what, pen.marks, texts)


def _labelled(
    thing: Thing, marks: list[Mark], lines: list[str], now: list[str], colour: str, *, below: bool, prefix: str = ""
) -> SymbolCell:
    """A symbol with its name above and its numbers below, or all of it below."""
    box = around(marks)
    name = prefix + thing.name
    ink = colour if colour in (WRONG.colour, WARM.colour) else INK.colour
    texts, y = list[Text](), box.low - GAP
    if below:
        y -= 0.78 * NAME
        texts.append(Text(0.0, y, name, NAME, ink, True))
        y -= LINE - 0.78 * VALUE
    else:
        texts.append(Text(0.0, box.high + GAP + 0.24 * NAME, name, NAME, ink, True))
    for number, line in enumerate([*lines, *now]):
        y -= 0.78 * VALUE if number == 0 else LINE
        texts.append(Text(0.0, y, line, VALUE, NOW if number >= len(lines) else colour, False))
    return SymbolCell(thing.name, thing.what, marks, texts)
