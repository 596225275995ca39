"""What stands above and below every diagram: its title, the gear, what its colours mean."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from clutchwork.diagrams.letters import width_of
from clutchwork.diagrams.marks import GREY, INK, NAME, TITLE, Pen
from clutchwork.schematic.pen import Rect

if TYPE_CHECKING:
    from clutchwork.diagrams.shown import BoxAtWork
    from clutchwork.gearbox.definition import Definition


def draw_title(pen: Pen, box: Rect, what: Definition, now: BoxAtWork | None) -> None:
    """Name of the gearbox and gear above what is drawn."""
    high = box.low - 14.0
    if now is not None:
        pen.label(box.left, high, now.caption, NAME, GREY, anchor="start")
        high -= 16.0
    pen.label(box.left, high, what.title or what.name, TITLE, INK, bold=True, anchor="start")


def draw_legend(pen: Pen, box: Rect, entries: Sequence[tuple[str, str]]) -> None:
    """Colours and what they mean, below what is drawn, in as many rows as it takes."""
    x, y = box.left, box.high + 20.0
    for colour, text in entries:
        wide = 22.0 + width_of(text, NAME) + 16.0
        if x > box.left and x + wide > max(box.right, box.left + 240.0):
            x, y = box.left, y + 16.0
        pen.line((x, y - 3.5), (x + 16.0, y - 3.5), colour=colour, width=4.0)
        pen.label(x + 22.0, y, text, NAME, INK, anchor="start")
        x += wide
