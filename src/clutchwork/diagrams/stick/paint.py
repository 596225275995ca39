"""A stick diagram from its layout."""

from __future__ import annotations

from typing import TYPE_CHECKING

from clutchwork.diagrams.marks import GREY, Mark, Pen
from clutchwork.diagrams.shown import shown
from clutchwork.diagrams.stick.layout import Layout
from clutchwork.diagrams.stick.lines import draw_lines
from clutchwork.diagrams.stick.looks import Scene
from clutchwork.diagrams.stick.parts import ARROW, LEGEND, draw_parts
from clutchwork.diagrams.stick.wheels import draw_body, draw_names
from clutchwork.diagrams.title import draw_legend, draw_title
from clutchwork.schematic.pen import around

if TYPE_CHECKING:
    from clutchwork.diagrams.shown import Drawable
    from clutchwork.gearbox.definition import Definition

BELOW = 18.0  # px from the centre line to names of sets


def painted(box: Definition, plan: Layout, at_work: Drawable) -> list[Mark]:
    """All marks of a stick diagram."""
    now = shown(at_work)
    scene, pen = Scene(box, plan, now), Pen()
    pen.line((-ARROW, 0.0), (plan.columns[-1] + ARROW, 0.0), colour=GREY, width=0.8, dash="12 3 2 3")
    draw_lines(pen, scene)
    for body in plan.bodies:
        draw_body(pen, scene, body)
    columns = [scene.at(planet.at)[0] for body in plan.bodies for planet in body.planets]
    draw_parts(pen, scene, min(columns), max(columns))
    for body in plan.bodies:
        draw_names(pen, scene, body, BELOW)
    draw_title(pen, around(pen.marks), box, now)
    if now is not None:
        draw_legend(pen, around(pen.marks), LEGEND)
    return pen.marks
