"""The speed of every member in every gear: a row of bars for each member, with their values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from clutchwork.diagrams.letters import width_of
from clutchwork.diagrams.marks import FAINT, GREY, HELD, IDLE, INK, NAME, POWER, SMALL, Mark, Pen
from clutchwork.diagrams.power import sources
from clutchwork.diagrams.shown import of_gear
from clutchwork.diagrams.shown import shown as as_shown
from clutchwork.diagrams.speed.plan import name_of
from clutchwork.diagrams.title import draw_legend, draw_title
from clutchwork.schematic.pen import Rect, around

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition
    from clutchwork.gearbox.state import GearState

COLUMN, LEAST, UNIT, BAR = 46.0, 13.0, 16.0, 22.0  # px: between gears, of a row, of a speed of 1, width of a bar
LEGEND = ((POWER, "turns with power"), (IDLE, "turns without power"), (HELD, "held"))


def painted(box: Definition, states: Sequence[GearState], now: GearState | None) -> list[Mark]:
    """All marks of a chart; without a gear to show, of all."""
    pen = Pen()
    shown = [state for state in states if now is None or state.closed == now.closed]
    left = 14.0 + max(width_of(member, NAME) for member in box.members)
    right = left + COLUMN * len(shown)
    powers = [sources(box, of_gear(state)) for state in shown]
    unit = UNIT * min(1.0, 6.0 / max(1.0, *(abs(v) for state in shown for v in state.speeds.values())))
    y = 0.0
    for number, state in enumerate(shown):
        pen.label(left + COLUMN * (number + 0.5), -6.0, name_of(state), NAME + 0.5, INK, bold=True)
    for member in box.members:
        speeds = [state.speeds[member] for state in shown]
        y += LEAST + unit * max(0.0, *speeds)
        pen.line((left, y), (right, y), colour=FAINT, width=0.8, what=member)
        pen.label(0.0, y + 3.6, member, NAME, INK, anchor="start")
        for number, (speed, given) in enumerate(zip(speeds, powers, strict=True)):
            power = max((abs(p) for p in given[member].values()), default=0.0)
            _draw_bar(pen, left + COLUMN * (number + 0.5), y, speed, unit, power)
        y += 8.0 + unit * max(0.0, *(-speed for speed in speeds)) + (LEAST if min(speeds) < 0 else 0.0)
    pen.label(left, y + 10.0, "speed over that of the input", SMALL, GREY, anchor="start")
    draw_legend(pen, Rect(0.0, 0.0, right, y + 10.0), LEGEND)
    draw_title(pen, around(pen.marks), box, as_shown(now))
    return pen.marks


def _draw_bar(pen: Pen, x: float, y: float, speed: float, unit: float, power: float) -> None:
    colour = HELD if abs(speed) < 1e-9 else POWER if power > 1e-9 else IDLE
    end = y - unit * speed
    if colour == HELD:
        pen.line((x - 0.5 * BAR, y), (x + 0.5 * BAR, y), colour=HELD, width=3.0)
    else:
        pen.rectangle(Rect(x - 0.5 * BAR, min(y, end), x + 0.5 * BAR, max(y, end)), colour)
    text = f"{speed:.3f}".replace("-", "\N{MINUS SIGN}") if colour != HELD else "0"
    pen.label(x, end - 3.5 if speed >= 0 else end + 9.5, text, SMALL, INK)
