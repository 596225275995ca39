"""A lever diagram from its layout; of a gear, the speeds at each lever as arrows below it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from clutchwork.diagrams.letters import width_of
from clutchwork.diagrams.lever.heights import Hung
from clutchwork.diagrams.lever.layout import Levers
from clutchwork.diagrams.marks import GREY, INK, NAME, PAPER, SMALL, Mark, Pen
from clutchwork.diagrams.shown import shown
from clutchwork.diagrams.stick.bodies import Body
from clutchwork.diagrams.stick.lines import draw_lines
from clutchwork.diagrams.stick.looks import Scene
from clutchwork.diagrams.stick.parts import LEGEND, draw_parts
from clutchwork.diagrams.stick.wheels import ground
from clutchwork.diagrams.title import draw_legend, draw_title
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.schematic.pen import around

if TYPE_CHECKING:
    from clutchwork.diagrams.shown import BoxAtWork, Drawable
    from clutchwork.gearbox.definition import Definition

# px: to the names of levers, to the speeds below, length of the longest arrow
NAMES, PANEL, LONGEST = 20.0, 44.0, 90.0
ROW, BESIDE, BOLD = 15.0, 8.0, 1.12  # px: between rows of names, beside a name; how much wider bold letters are


def painted(box: Definition, drawn: Levers, at_work: Drawable) -> list[Mark]:
    """All marks of a lever diagram."""
    now = shown(at_work)
    scene, pen = Scene(box, drawn.plan, now), Pen()
    draw_lines(pen, scene)
    for one, body in zip(drawn.hung, drawn.plan.bodies, strict=True):
        _draw_lever(pen, scene, one, body)
    columns = [scene.at(piece.root)[0] for body in drawn.plan.bodies for piece in body.pieces.values()]
    draw_parts(pen, scene, min(columns), max(columns))
    _draw_names(pen, scene, drawn.plan.bodies)
    if now is not None:
        draw_legend(pen, around(pen.marks), LEGEND)
        _draw_speeds(pen, now, drawn)
    draw_title(pen, around(pen.marks), box, now)
    return pen.marks


def _draw_names(pen: Pen, scene: Scene, bodies: Sequence[Body]) -> None:
    """Names of levers below them, in as many rows as it takes."""
    ends = list[float]()
    for body in bodies:
        x, _ = scene.at(next(iter(body.pieces.values())).root)
        name = body.name.replace("+", " + ")
        half = width_of(name, NAME + 0.5) / 2 * BOLD
        row = next((row for row, end in enumerate(ends) if end < x - half), len(ends))
        ends[row : row + 1] = [x + half + BESIDE]
        pen.label(x, NAMES + ROW * row, name, NAME + 0.5, INK, bold=True)


def _draw_lever(pen: Pen, scene: Scene, one: Hung, body: Body) -> None:
    places = [scene.at(piece.root) for piece in body.pieces.values()]
    x, low, high = places[0][0], max(y for _, y in places), min(y for _, y in places)
    pen.line((x, low), (x, high), colour=INK, width=3.2, what=body.name)
    for (_, member), piece in body.pieces.items():
        _, y = scene.at(piece.root)
        if member == HOUSING:
            end = scene.at(piece.ends[0])
            colour = scene.colour(HOUSING)
            pen.line(end, (x, y), colour=colour, width=1.5, what=HOUSING)
            ground(pen, (end[0], y - 8.0), (end[0], y + 8.0), (-1.0, 0.0), colour)
        pen.dot(x, y, 4.0, PAPER, INK, 1.6)
        pen.label(x + 7.0, y - 8.2, one.lever.label(member), SMALL, GREY, anchor="start")


def _draw_speeds(pen: Pen, now: BoxAtWork, drawn: Levers) -> None:
    """Each lever once more, with the speed of each of its members as an arrow, all to one scale."""
    speeds = {HOUSING: 0.0, **now.speeds}
    most = max(abs(speeds[member]) for one in drawn.hung for member in one.heights)
    scale = LONGEST / max(most, 1.0)
    box = around(pen.marks)
    x, top = box.left, box.high + PANEL
    pen.label(x, top - 12.0, f"speeds over {now.speeds_of}, {scale:.0f} px = 1", NAME, GREY, anchor="start")
    for one in drawn.hung:
        shown = {member: speeds[member] for member in one.heights}
        high = max(one.heights.values())
        zero = x + 8.0 - scale * min(0.0, *shown.values())
        _draw_arrows(pen, {m: (zero, top + 8.0 + high - h) for m, h in one.heights.items()}, shown, scale)
        words = max(width_of(_words(m, v), SMALL) for m, v in shown.items())
        pen.label(zero, top + 28.0 + high - min(one.heights.values()), " + ".join(one.lever.sets), NAME, INK, bold=True)
        x = zero + scale * max(0.0, *shown.values()) + words + 34.0


def _draw_arrows(pen: Pen, places: dict[str, tuple[float, float]], speeds: dict[str, float], scale: float) -> None:
    (first, (x, low)), (last, (_, high)) = (f(places.items(), key=lambda item: item[1][1]) for f in (max, min))
    pen.line((x, low), (x, high), colour=INK, width=1.6)
    ends = ((x + scale * speeds[first], low), (x + scale * speeds[last], high))
    pen.line(*ends, colour=GREY, width=1.0, dash="4 2.5")
    furthest = max(x, *(x + scale * speed for speed in speeds.values()))
    for member, (_, y) in places.items():
        colour = INK
        tip = x + scale * speeds[member]
        if abs(tip - x) > 0.5:
            way = 1.0 if tip > x else -1.0
            pen.line((x, y), (tip - 5.0 * way, y), colour=colour, width=1.8)
            pen.arrow((tip, y), (way, 0.0), min(8.0, abs(tip - x)), colour)
        pen.dot(x, y, 2.6, PAPER, colour, 1.4)
        pen.label(furthest + 8.0, y + 3.2, _words(member, speeds[member]), SMALL, INK, anchor="start")


def _words(member: str, speed: float) -> str:
    return f"{member} {speed:.3f}".replace("-", "\N{MINUS SIGN}") if member != HOUSING else "housing"
