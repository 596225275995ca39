"""The speed plan of Kutzbach: members at places by the teeth, speeds above them, a straight line for each gear.

A gearbox that is not one lever has a ladder for each; a member that stands in several has the same speed in all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import ceil, floor
from typing import TYPE_CHECKING

from clutchwork.base import dataclass
from clutchwork.diagrams.letters import width_of
from clutchwork.diagrams.lever.points import Lever, levers
from clutchwork.diagrams.marks import FAINT, GREY, HELD, INK, NAME, POWER, SMALL, Mark, Pen
from clutchwork.diagrams.shown import shown
from clutchwork.diagrams.title import draw_title
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.schematic.pen import around

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition
    from clutchwork.gearbox.state import GearState

# px: a ladder, and more where it is alone; gaps of members and ladders; at most the height, and a speed of 1
LADDER, ALONE, STEP, BETWEEN, TALLEST, UNIT = 120.0, 120.0, 15.0, 44.0, 460.0, 130.0
TICK, ROW = 30.0, 12.5
# apart for every eye, dark enough on white
COLOURS = ("#00497A", "#B8430A", "#0B6E4F", "#7A2E8E", "#8A6D00", "#A3123F", "#3B5BA5", "#5A5A5A", "#00797A", "#6B3E1E")


@dataclass(frozen=True)
class Ladder:
    """A lever of the plan with its members at their places [px]."""

    lever: Lever
    columns: Mapping[str, float]


def ladders(box: Definition, words: float) -> list[Ladder]:
    """Ladders side by side, with room for words on the right of each; sets that share two members are one."""
    made, left = list[Ladder](), 0.0
    found = levers(box.sets, merged=True)
    for lever in found:
        places = {member: float(place) for member, place in lever.places.items()}
        steps = sorted(places.values())
        least = max(STEP / (b - a) for a, b in pairwise(steps))
        wide = max(LADDER + ALONE / len(found), least)
        made.append(Ladder(lever, {member: left + wide * place for member, place in places.items()}))
        left += wide + BETWEEN + words
    return made


def name_of(state: GearState) -> str:
    """Of a gear; of closed elements that are none of the table, these."""
    return state.gear or "+".join(state.closed)


def span(made: Sequence[Ladder], states: Sequence[GearState]) -> tuple[float, float, float]:
    """Lowest and highest speed, and the height of a speed of 1 [px]."""
    shown = [state.speeds.get(member, 0.0) for state in states for one in made for member in one.columns]
    low, high = min([0.0, *shown]), max([1.0, *shown])
    return low, high, min(UNIT, TALLEST / (high - low))


def painted(box: Definition, states: Sequence[GearState], now: GearState | None) -> list[Mark]:
    """All marks of a speed plan; the line of one gear stands out where `now` is given."""
    pen, speeds = Pen(), {name_of(state): {HOUSING: 0.0, **state.speeds} for state in states}
    made = ladders(box, 12.0 + max((width_of(gear, NAME, bold=True) for gear in speeds), default=0.0))
    low, high, scale = span(made, states)
    columns = [column for one in made for column in one.columns.values()]
    _draw_scale(pen, low, high, scale, min(columns), max(columns))
    for one in made:
        below = _draw_members(pen, one.columns, low, high, scale)
        _draw_gears(pen, one.columns, speeds, scale, now)
        middle = 0.5 * (min(one.columns.values()) + max(one.columns.values()))
        pen.label(middle, below + 18.0, " + ".join(one.lever.sets), NAME + 0.5, INK, bold=True)
    draw_title(pen, around(pen.marks), box, shown(now))
    return pen.marks


def _draw_scale(pen: Pen, low: float, high: float, scale: float, left: float, right: float) -> None:
    """Speeds over that of the input, with lines across."""
    step = next(step for step in (0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 1e9) if step * scale >= 26.0)
    for number in range(ceil(low / step), floor(high / step) + 1):
        y, value = -scale * step * number, step * number
        mark = HELD if value == 0 else INK if value == 1 else FAINT
        pen.line(
            (left - 6.0, y),
            (right, y),
            colour=mark,
            width=0.9 if value in (0, 1) else 0.6,
            dash="" if value in (0, 1) else "2 3",
        )
        pen.label(left - TICK + 18.0, y + 3.2, f"{value:g}".replace("-", "\N{MINUS SIGN}"), SMALL, INK, anchor="end")
    text = "speed over that of the input"
    pen.label(left - TICK - 6.0, -scale * high - 26.0 - ROW, text, SMALL, GREY, anchor="start")


def _draw_members(pen: Pen, columns: Mapping[str, float], low: float, high: float, scale: float) -> float:
    """A line for each member; names in as many rows as they need; where the last of these is."""
    last = float("-inf")
    ends = [float("-inf")] * 8
    for member, x in sorted(columns.items(), key=lambda item: item[1]):
        half = 0.5 * width_of(member, SMALL) + 3.0
        row = next((n for n, end in enumerate(ends) if end <= x - half), len(ends) - 1)
        ends[row] = x + half
        top, bottom = -scale * high - 8.0, -scale * low + 10.0
        pen.line((x, top), (x, bottom), colour=GREY, width=1.0, what=member)
        pen.label(x, bottom + 10.0 + ROW * row, member, SMALL, INK)
        last = max(last, bottom + 10.0 + ROW * row)
    return last


def _draw_gears(
    pen: Pen,
    columns: Mapping[str, float],
    speeds: Mapping[str, Mapping[str, float]],
    scale: float,
    now: GearState | None,
) -> None:
    """A straight line for each gear, its name at its right end."""
    order = sorted(columns, key=lambda member: columns[member])
    right = columns[order[-1]]
    ends = spread([-scale * of[order[-1]] for of in speeds.values()], ROW)
    for number, ((gear, of), place) in enumerate(zip(speeds.items(), ends, strict=True)):
        plain = now is None or gear == name_of(now)
        colour = COLOURS[number % len(COLOURS)] if now is None else POWER if plain else FAINT
        points = [(columns[member], -scale * of[member]) for member in order]
        pen.line(points[0], points[-1], colour=colour, width=2.4 if now and plain else 1.4, what=f"gear {gear}")
        for x, y in points:
            pen.dot(x, y, 2.4, colour)
        pen.line((right + 3.0, points[-1][1]), (right + 10.0, place), colour=colour, width=0.7)
        pen.label(right + 12.0, place + 3.6, gear, NAME, colour if plain else GREY, bold=True, anchor="start")


def spread(wanted: Sequence[float], apart: float) -> list[float]:
    """Places of labels as near to the wanted ones as they may be, no two nearer than `apart`."""
    order = sorted(range(len(wanted)), key=lambda n: (wanted[n], n))
    # blocks of places that touch: the sum of wanted tops, and how many
    blocks: list[list[float]] = []
    for place, number in enumerate(order):
        blocks.append([wanted[number] - apart * place, 1.0])
        while len(blocks) > 1 and blocks[-2][0] / blocks[-2][1] >= blocks[-1][0] / blocks[-1][1]:
            total, count = blocks.pop()
            blocks[-1][0] += total
            blocks[-1][1] += count
    found, place = [0.0] * len(order), 0
    for total, count in blocks:
        for _ in range(int(count)):
            found[order[place]] = total / count + apart * place
            place += 1
    return found
