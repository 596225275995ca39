"""Parallel axes from their layout."""

from __future__ import annotations

from typing import TYPE_CHECKING

from clutchwork.diagrams.axes.layout import APART, Axes
from clutchwork.diagrams.marks import GREY, HELD, IDLE, INK, NAME, PAPER, POWER, SMALL, Mark, Pen
from clutchwork.diagrams.power import sources
from clutchwork.diagrams.shown import shown
from clutchwork.diagrams.stick import symbols
from clutchwork.diagrams.title import draw_legend, draw_title
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.schematic.pen import around

if TYPE_CHECKING:
    from clutchwork.diagrams.shown import BoxAtWork, Drawable
    from clutchwork.gearbox.definition import Definition, ShiftElement

THIN, THICK, LOST = 1.5, 2.6, 1e-9
LEGEND = ((POWER, "turns with power, as wide as the power"), (HELD, "held"), (IDLE, "turns without power"))


class _Scene:
    """Colours and widths by the power that each member carries."""

    def __init__(self, box: Definition, now: BoxAtWork | None) -> None:
        self.now = now
        given = sources(box, now) if now else {}
        # half of what goes in and out
        self.power = {member: sum(map(abs, some.values())) / 2 for member, some in given.items()}

    def colour(self, member: str) -> str:
        if self.now is None:
            return INK
        if self.power.get(member, 0.0) > LOST:
            return POWER
        return HELD if abs(self.now.speeds[member]) < LOST else IDLE

    def width(self, member: str) -> float:
        return THIN + THICK * min(self.power.get(member, 0.0), 1.25)


def painted(box: Definition, plan: Axes, at_work: Drawable) -> list[Mark]:
    """All marks of a drawing of parallel axes."""
    now, pen = shown(at_work), Pen()
    scene = _Scene(box, now)
    for member in box.members:
        _draw_shaft(pen, box, plan, scene, member)
    for one in box.sets:
        x, (first, second) = plan.columns[one.name], (one.members["first"], one.members["second"])
        low, high = sorted((plan.heights[first], plan.heights[second]))
        beside = high - low < 1.5 * APART
        ends = sorted(zip((plan.heights[first], plan.heights[second]), plan.halves[one.name], strict=True))
        pen.line(
            (x, ends[0][0] + ends[0][1]), (x, ends[1][0] - ends[1][1]), colour=scene.colour(second),
            width=1.2, dash="" if beside else "3 3",
        )  # fmt: skip
        power = max(map(abs, now.set_powers[one.name].values())) if now else 0.0
        for member, half in zip((first, second), plan.halves[one.name], strict=True):
            _draw_wheel(pen, plan, scene, member, (x, half), power)
        pen.label(x + 4.0, max(ends)[0] + max(ends)[1] + 11.0, one.name, SMALL, GREY, anchor="start")
    for element in box.elements:
        _draw_element(pen, box, plan, scene, element)
    _draw_ends(pen, box, plan, scene)
    draw_title(pen, around(pen.marks), box, now)
    if now is not None:
        draw_legend(pen, around(pen.marks), LEGEND)
    return pen.marks


def _draw_shaft(pen: Pen, box: Definition, plan: Axes, scene: _Scene, member: str) -> None:
    """A line from the first thing on a member to the last one."""
    y = plan.heights[member]
    places = [plan.columns[one.name] for one in box.sets if member in one.members.values()]
    places += [plan.symbols[one.name] for one in box.elements if member in one.members]
    if member == box.input:
        places.append(0.0)
    if member == box.output:
        places.append(plan.right)
    if len(places) > 1:
        pen.line(
            (min(places), y), (max(places), y), colour=scene.colour(member), width=scene.width(member), what=member
        )


def _draw_wheel(pen: Pen, plan: Axes, scene: _Scene, member: str, place: tuple[float, float], power: float) -> None:
    """A wheel from the side, by its column and half its size; one that turns on another shaft has a ring there."""
    (x, half), y, colour = place, plan.heights[member], scene.colour(member)
    colour = IDLE if colour == POWER and power < LOST else colour
    width = THIN + THICK * min(power, 1.25)
    pen.line((x, y - half), (x, y + half), colour=colour, width=width, what=member)
    for end in (y - half, y + half):
        pen.line((x - 6.0, end), (x + 6.0, end), colour=colour, width=width)
    if member in plan.loose:
        pen.dot(x, y, 3.4, PAPER, colour, 1.4)


def _draw_element(pen: Pen, box: Definition, plan: Axes, scene: _Scene, element: ShiftElement) -> None:
    x, closed = plan.symbols[element.name], scene.now is None or element.name in scene.now.closed
    kind = "dog" if element.kind == "synchroniser" else element.kind
    driven = next((member for member in element.members if member not in (box.input, HOUSING)), element.second)
    y = plan.heights[driven]
    sides = tuple(scene.colour(member) if member != HOUSING else HELD for member in element.members)
    between = sides[0] if closed and scene.now else PAPER
    looks = symbols.Looks((sides[0], sides[1]), between)
    symbols.draw(pen, kind, (x, y), (1.0, 0.0), (6.0, 6.0), looks)
    if box.input in element.members and y != plan.heights[box.input]:
        pen.line((x - 6.0, plan.heights[box.input]), (x - 6.0, y), colour=scene.colour(box.input), width=1.5)
    above = y <= plan.heights[box.input]
    pen.label(
        x, y - 13.0 if above else y + 21.0, element.name, SMALL, INK if closed else GREY, bold=closed, anchor="middle"
    )


def _draw_ends(pen: Pen, box: Definition, plan: Axes, scene: _Scene) -> None:
    for member, x, text, anchor in ((box.input, 0.0, "input", "start"), (box.output, plan.right, "output", "end")):
        y, colour = plan.heights[member], scene.colour(member)
        pen.arrow((x + (14.0 if member == box.input else 10.0), y), (1.0, 0.0), 11.0, colour)
        pen.label(x, y - 10.0, text, NAME, INK, anchor=anchor)
    names = {member for element in box.elements for member in element.members}
    for one in box.sets:
        names |= {one.members["first"]}
    for member in sorted(names - plan.loose - {box.input, box.output, HOUSING}):
        places = [plan.columns[one.name] for one in box.sets if member in one.members.values()]
        if places:
            y = plan.heights[member]
            # the lower one of two lines has its name below
            below = 12.0 if y > plan.heights[box.input] and abs(y - plan.heights[box.input]) < APART / 2 else -5.0
            pen.label(max(places) - 8.0, y + below, member, SMALL, GREY, anchor="end")
