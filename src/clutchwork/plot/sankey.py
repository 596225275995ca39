"""A Sankey picture of a table of losses: sources left, load right, heat down, what is stored up."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from clutchwork.plot.figure import figure_of, written
from clutchwork.plot.sankey_graph import Graph, graph
from clutchwork.plot.sankey_places import ARROW, BAR, BoxPlace, Path, SankeyLayout, places
from clutchwork.plot.style import COLOURS, MILLIMETRE

if TYPE_CHECKING:
    from pathlib import Path as FilePath

    from clutchwork.plot.canvas import Picture
    from clutchwork.results.losses import LossTable

WORK, HEAT, STORED, INK = COLOURS[0], COLOURS[1], COLOURS[2], "#333333"
SHADE = 0.45
# words are read over ribbons
CLEAR = {"facecolor": "white", "alpha": 0.6, "linewidth": 0.0, "pad": 0.4}
# per column and in all [mm]
PITCH, WIDE, WIDEST = 17.0, 180.0, 420.0
HEAD, FOOT = 9.0, 7.0
PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""))


def amount(value: float, unit: str) -> str:
    """A number with three digits and a prefix: "98.7 kJ"."""
    scale, prefix = next((item for item in PREFIXES if abs(value) >= 0.9995 * item[0]), PREFIXES[-1])
    number = value / scale
    # as it is rounded: 0.9996 is 1.00
    digits = max(0, 2 - math.floor(math.log10(1.0005 * abs(number)))) if number else 0
    return f"{number:.{min(digits, 3)}f} {prefix}{unit}"


def parts(table: LossTable) -> tuple[Picture | None, list[str]]:
    """The picture and the table in a notebook; no picture without matplotlib."""
    try:
        return draw(table), [table._repr_html_()]
    except ImportError:
        return None, [table._repr_html_()]


def draw(table: LossTable, path: FilePath | None = None) -> Picture:
    """The picture, written to a path where there is one."""
    first, last = table.shafts or (None, None)
    made = graph(table, first, last)
    count = 1 + max(made.column.values(), default=0)
    where = places(made, min(WIDEST, max(WIDE, PITCH * count)))
    with figure_of(where.high + HEAD + FOOT, formulas=False, width=where.wide * MILLIMETRE) as figure:
        figure.set_layout_engine("none")
        axes: Any = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set_xlim(0.0, where.wide)
        axes.set_ylim(-FOOT, where.high + HEAD)
        axes.axis("off")
        for one in where.paths:
            _ribbon(axes, one)
        for name in made.boxes:
            _box(axes, made, where, name, table.unit)
        window = f"{table.model}, {'mean power' if table.power else 'energy'} from {table.begin:g} to {table.end:g} s"
        axes.text(4.0, where.high + HEAD - 4.0, window, fontsize=8.5, va="top", color=INK)
        _legend(axes, where, table, made)
        return written(figure, path)


def _legend(axes: Any, where: SankeyLayout, table: LossTable, made: Graph) -> None:
    """What colours mean, what all heat is, what is not shown."""
    parts = [("mechanical", WORK), ("heat", HEAT), ("stored: kinetic, elastic", STORED)]
    left = 4.0
    for word, colour in parts:
        axes.fill([left, left + 3.0, left + 3.0, left], [-4.6, -4.6, -2.6, -2.6], color=colour, alpha=0.7, linewidth=0)
        axes.text(left + 4.0, -3.6, word, fontsize=6.5, va="center", color=INK)
        left += 8.0 + 1.35 * len(word)
    words = [f"all heat {amount(table.heat, table.unit)}"]
    if math.isfinite(table.efficiency):
        words.append(f"efficiency {table.efficiency:.1%}")
    words += [f"{made.left_out} too small to draw left out"] if made.left_out else []
    axes.text(where.wide - 4.0, -3.6, ", ".join(words), fontsize=6.5, va="center", ha="right", color=INK)


def _ribbon(axes: Any, path: Path) -> None:
    """A ribbon of even thickness, with marks that point where energy goes."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    half, points = 0.5 * path.thick, path.points
    upper = _curve(points, half)
    lower = _curve(points, -half)[::-1]
    codes = [Outline.MOVETO, *[Outline.CURVE4] * (len(upper) - 1), Outline.LINETO, *[Outline.CURVE4] * (len(lower) - 1)]
    axes.add_patch(
        PathPatch(
            Outline([*upper, *lower, upper[0]], [*codes, Outline.CLOSEPOLY]), facecolor=WORK, alpha=SHADE, linewidth=0
        )
    )
    (x0, y0), (x1, y1) = points[0], points[1]
    _mark(axes, 0.5 * (x0 + x1), 0.5 * (y0 + y1), path)


def _curve(points: tuple[tuple[float, float], ...], offset: float) -> list[tuple[float, float]]:
    """Control points of a curve that is level at every point."""
    made = [(points[0][0], points[0][1] + offset)]
    for (x0, y0), (x1, y1) in pairwise(points):
        middle = 0.5 * (x0 + x1)
        made += [(middle, y0 + offset), (middle, y1 + offset), (x1, y1 + offset)]
    return made


def _mark(axes: Any, x: float, y: float, path: Path) -> None:
    """A point of an arrow in the middle of the first stretch."""
    size = min(1.6, max(0.7, 0.35 * path.thick))
    side = 1.0 if path.ribbon.energy > 0.0 else -1.0
    tip = x + side * size
    back = x - side * 0.6 * size
    axes.fill([back, tip, back], [y + size, y, y - size], color="white" if path.thick > 2.5 else INK, linewidth=0)


def _box(axes: Any, made: Graph, where: SankeyLayout, name: str, unit: str) -> None:
    """A box with its name and what goes through it, its heat and what it stores."""
    box, place = made.boxes[name], where.boxes[name]
    colour = "#9A9A9A" if box.is_shaft else INK
    low, top = place.y - 0.5 * place.high, place.y + 0.5 * place.high
    right = place.x + BAR
    axes.fill([place.x, right, right, place.x], [low, low, top, top], color=colour, linewidth=0, zorder=3)
    if box.heat > 0.0:
        _bend(axes, place, where.scale * box.heat, HEAT, down=True)
        tip = low - ARROW + 3.6
        axes.text(right + 1.0 + 0.5 * where.scale * box.heat, tip, amount(box.heat, unit), **_words(HEAT), va="top")
    if box.stored:
        thick = where.scale * abs(box.stored)
        colour = STORED
        _bend(axes, place, thick, colour, down=False, left=box.stored < 0.0)
        middle = right + 1.0 + 0.5 * thick if box.stored > 0.0 else place.x - 1.0 - 0.5 * thick
        sign = "+" if box.stored > 0.0 else "\N{MINUS SIGN}"
        axes.text(middle, top + ARROW - 3.4, sign + amount(abs(box.stored), unit), **_words(STORED), va="bottom")
    _name(axes, made, where, name, unit)


def _words(colour: str) -> dict[str, Any]:
    return {"fontsize": 6.3, "ha": "center", "color": colour, "zorder": 6, "bbox": CLEAR}


def _name(axes: Any, made: Graph, where: SankeyLayout, name: str, unit: str) -> None:
    """The name above the bar, and for what has another end outside of the driveline how much goes there."""
    box, place = made.boxes[name], where.boxes[name]
    lines = [name]
    if box.outside:
        lines.append(amount(box.outside, unit).replace("-", "\N{MINUS SIGN}"))
    last = max(made.column.values())
    column = made.column[name]
    align = "left" if column == 0 or box.stored < 0.0 else "right" if column == last or box.stored else "center"
    x = {"left": place.x, "right": place.x + BAR, "center": place.x + 0.5 * BAR}[align]
    axes.text(
        x,
        place.y + 0.5 * place.high + 0.9,
        "\n".join(lines),
        fontsize=6.8,
        ha=align,
        va="bottom",
        color=INK,
        linespacing=1.15,
        zorder=6,
        bbox=CLEAR,
        fontweight="normal" if box.is_shaft else "bold",
    )


def _bend(axes: Any, place: BoxPlace, thick: float, colour: str, *, down: bool, left: bool = False) -> None:
    """Energy that turns down or up beside a bar, or comes from above on its left, with the point of an arrow."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    side, turn = (-1.0 if left else 1.0), (-1.0 if down else 1.0)
    edge = place.y + turn * 0.5 * place.high
    x0 = place.x if left else place.x + BAR
    inner, outer = x0 + side * 1.0, x0 + side * (1.0 + thick)
    end = edge + turn * (ARROW - 6.2)
    curve = 0.55
    k, r = curve, 1.0 + thick
    points = [
        (x0, edge),
        (x0 + side * k, edge),
        (inner, edge + turn * (1.0 - k)),
        (inner, edge + turn * 1.0),
        (inner, end),
        (outer, end),
        (outer, edge + turn * 1.0),
        (outer, edge + turn * (1.0 - k * r)),
        (x0 + side * k * r, edge - turn * thick),
        (x0, edge - turn * thick),
        (x0, edge),
    ]
    c4, line = Outline.CURVE4, Outline.LINETO
    codes = [Outline.MOVETO, c4, c4, c4, line, line, line, c4, c4, c4, Outline.CLOSEPOLY]
    axes.add_patch(PathPatch(Outline(points, codes), facecolor=colour, alpha=0.7, linewidth=0, zorder=2))
    middle, wide = 0.5 * (inner + outer), max(0.5 * thick + 0.6, 0.9)
    tip, base = (end + turn * 2.2, end) if not left else (edge + turn * 1.0, edge + turn * 3.2)
    if not left:
        axes.fill([middle - wide, middle + wide, middle], [base, base, tip], color=colour, alpha=0.7, linewidth=0)
    else:
        size = min(1.4, max(0.7, 0.3 * thick))
        mark = edge + turn * 0.5 * (ARROW - 6.2)
        axes.fill(
            [middle - size, middle + size, middle],
            [mark + size, mark + size, mark - size],
            color="white" if thick > 2.5 else INK,
            linewidth=0,
            zorder=4,
        )
