"""What stick and lever diagrams have in common: shift elements, housing, input and output."""

from __future__ import annotations

from math import hypot

from clutchwork.diagrams.marks import GREY, HELD, IDLE, INK, NAME, POWER, Pen, Point
from clutchwork.diagrams.power import sources
from clutchwork.diagrams.stick import symbols
from clutchwork.diagrams.stick.board import STEPS
from clutchwork.diagrams.stick.looks import Scene
from clutchwork.diagrams.stick.route import IN
from clutchwork.diagrams.stick.search import ShiftSymbol
from clutchwork.diagrams.stick.wheels import ground
from clutchwork.gearbox.definition import ShiftElement
from clutchwork.gearbox.gear_set import HOUSING

ARROW = 40.0  # px
LEGEND = ((POWER, "turns with power, as wide as the power"), (HELD, "held"), (IDLE, "turns without power"))


def draw_parts(pen: Pen, scene: Scene, left: float, right: float) -> None:
    """Shift elements, the housing above them from `left` to `right` [px], input and output."""
    for element in scene.box.elements:
        _draw_element(pen, scene, element)
    columns = [scene.at(symbol.first)[0] for symbol in scene.plan.symbols.values() if symbol.first == symbol.second]
    if columns:
        start, end = min(*columns, left) - 15.0, max(*columns, right) + 15.0
        ground(pen, (start, _roof(scene)), (end, _roof(scene)), (0.0, -1.0), scene.colour(HOUSING))
    for name in scene.plan.gates:
        _draw_gate(pen, scene, name)


def _roof(scene: Scene) -> float:
    """The housing."""
    return -scene.plan.rows[-1]


def _draw_element(pen: Pen, scene: Scene, element: ShiftElement) -> None:
    symbol, kind = scene.plan.symbols[element.name], element.kind
    looks = _looks(scene, element, symbol)
    a, b = STEPS[symbol.way]
    start, end = scene.at(symbol.first), scene.at(symbol.second)
    if HOUSING in element.members:
        roof, gap = _roof(scene), symbols.gap_of(kind)
        symbols.draw(pen, kind, (start[0], roof + gap), (0.0, -1.0), (start[1] - roof - gap, gap), looks)
    else:
        middle = scene.at(symbol.middle)
        reaches = (_far(start, middle), _far(middle, end))
        symbols.draw(pen, kind, middle, (float(a), float(-b)), reaches, looks)
    _draw_name(pen, scene, element, symbol)


def _draw_name(pen: Pen, scene: Scene, element: ShiftElement, symbol: ShiftSymbol) -> None:
    closed = scene.now is None or element.name in scene.now.closed
    x, y = scene.at(symbol.middle)
    right, above = symbol.label[0] > symbol.middle[0], symbol.label[1] > symbol.middle[1]
    if HOUSING in element.members:
        place, anchor = (x, _roof(scene) - 9.0), "middle"
    elif symbol.way < 2:
        place, anchor = (x, y - 13.0 if above else y + 20.5), "middle"
    else:
        place, anchor = (x + (12.5 if right else -12.5), y + 3.7), "start" if right else "end"
    pen.label(*place, element.name, NAME, INK if closed else GREY, bold=closed, anchor=anchor)


def _far(one: Point, other: Point) -> float:
    return hypot(one[0] - other[0], one[1] - other[1])


def _looks(scene: Scene, element: ShiftElement, symbol: ShiftSymbol) -> symbols.Looks:
    """Colours and widths of a symbol, its first end first."""
    if scene.now is None:
        return symbols.Looks()
    owner = scene.plan.ends[symbol.first]
    other = next((member for member in element.members if member != owner), owner)
    if element.name not in scene.now.closed:
        return symbols.Looks((scene.colour(owner), scene.colour(other)))
    power = sources(scene.box, scene.now)[owner].get((element.name, ""), 0.0)
    sides = (scene.colour(owner, power), scene.colour(other, power))
    return symbols.Looks(sides, sides[0], (scene.width(power),) * 2)


def _draw_gate(pen: Pen, scene: Scene, name: str) -> None:
    x, y = scene.at(scene.plan.gates[name])
    colour, width = scene.gate(name)
    if name == IN:
        pen.line((x - ARROW, y), (x, y), colour=colour, width=width)
        pen.arrow((x - 6.0, y), (1.0, 0.0), 9.0 + width, colour)
        pen.label(x - ARROW, y - 11.0, name, NAME, INK, anchor="start")
    else:
        pen.line((x, y), (x + ARROW - 8.0, y), colour=colour, width=width)
        pen.arrow((x + ARROW, y), (1.0, 0.0), 9.0 + width, colour)
        pen.label(x + ARROW, y - 11.0, name, NAME, INK, anchor="end")
