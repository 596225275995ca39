"""A picture of chosen signals: a panel for each unit, events marked, several runs and samples beside each other."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.plot import panels as looks_of
from clutchwork.plot.curves import Curve, Panel, Side, thinned
from clutchwork.plot.figure import figure_of, written
from clutchwork.plot.style import DASHES, EVENT_LINE, MILLIMETRE, NARROW, WIDTH, colours, looks
from clutchwork.plot.view import View, happened

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from clutchwork.plot.canvas import Picture

HEIGHT, LINE, MOST_LINES = 40.0, 3.9, 18  # mm of a panel, mm of a line of its legend, lines of one column
COLUMNS = 2  # of a legend above a panel
# four for each dot across the picture: what is left out cannot be seen
MOST_POINTS = 40_000
# shares of the width: what a letter of a word at an event needs, and how far behind its line a word may begin
LETTER, BEHIND = 0.0100, 0.02
POINTS: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 2.4, "markeredgewidth": 0.0, "alpha": 0.65}


def draw(view: View, panels: Sequence[Panel], path: Path | None, colour: str, width: float = WIDTH) -> Picture:
    """Draw panels below each other over the same time, and write the picture where there is a path.

    Parameters: width [inch].
    """
    narrow = width < NARROW * MILLIMETRE
    heights = [HEIGHT if narrow else _height(panel) for panel in panels]
    above = sum(LINE * (_rows(panel) + 1.0) for panel in panels) if narrow else 0.0
    # a dollar in a name is a dollar
    with figure_of(sum(heights) + 5.0 * len(panels) + 13.0 + above, formulas=False, width=width) as figure:
        rows = figure.subplots(len(panels), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
        for axes, panel in zip(rows, panels, strict=True):
            _panel(axes, panel, view, colour)
        rows[0].set_xlim(view.begin, view.end)
        rows[-1].set_xlabel("time, s")
        _words(rows[0], view, LETTER * WIDTH / width)
        figure.align_ylabels(rows)
        return written(figure, path)


def _height(panel: Panel) -> float:
    """Tall enough for the legend."""
    return max(HEIGHT, LINE * min(len(panel.curves), MOST_LINES) + 4.0)


def _rows(panel: Panel) -> int:
    """Lines of a legend above a panel."""
    return -(-len(panel.curves) // COLUMNS)


def _panel(axes: Axes, panel: Panel, view: View, colour: str) -> None:
    styles = curve_looks(panel.curves, list(view.runs), colour)
    handles = []
    for number, side in enumerate(panel.sides):
        own = axes if number == 0 else axes.twinx()
        handles += [_curve(own, curve, side, style) for curve, style in zip(side.curves, styles, strict=False)]
        styles = styles[len(side.curves) :]
        own.set_ylabel(side.label)
        own.margins(y=0.08)
        if side.words:
            own.set_yticks(list(side.words), list(side.words.values()))
            own.set_ylim(min(side.words) - 0.4, max(side.words) + 0.4)
        if number:
            own.grid(visible=False)
            own.spines["right"].set_visible(True)
    for instant in dict.fromkeys(event.time for _, event in view.marks):
        axes.axvline(instant, **EVENT_LINE)
    _legend(axes, panel, handles)


def _curve(axes: Axes, curve: Curve, side: Side, look: dict[str, Any]) -> Any:
    time, values = thinned(curve.time, side.factor * curve.values, MOST_POINTS)
    (line,) = axes.plot(time, values, label=looks_of.named(curve.label), **look)
    looks_of.dotted([line])
    return line


def _legend(axes: Axes, panel: Panel, handles: Sequence[Any]) -> None:
    """To the right, where it covers nothing; which curves belong to the right axis is said."""
    labels = [looks_of.named(curve.label) for curve in panel.curves]
    if len(panel.sides) > 1:
        units = [side.unit or "state" for side in panel.sides for _ in side.curves]
        labels = [f"{label} [{unit}]" for label, unit in zip(labels, units, strict=True)]
    away = 1.0 if len(panel.sides) == 1 else 1.11
    if looks_of.is_narrow(axes):
        looks_of.above(axes, handles, labels, COLUMNS)
        return
    axes.legend(
        handles, labels, loc="upper left", bbox_to_anchor=(away, 1.02), borderaxespad=0.3, alignment="left",
        ncols=-(-len(labels) // MOST_LINES), handlelength=2.4, labelspacing=0.3, columnspacing=0.8,
    )  # fmt: skip


def curve_looks(curves: Sequence[Curve], runs: Sequence[str], colour: str) -> list[dict[str, Any]]:
    """Colour and dashes of each curve: of one run by signal; of several by run and signal, or vice versa."""
    signals = list(dict.fromkeys(curve.signal for curve in curves))
    if len(runs) < 2:
        own = dict(zip(signals, looks(len(signals)), strict=True))
        return [{**own[curve.signal], **(POINTS if curve.measured else {})} for curve in curves]
    made, hues = [], colours()
    for curve in curves:
        run, signal = (0 if curve.measured else runs.index(curve.run)), signals.index(curve.signal)
        hue, dash = (run, signal) if colour == "run" else (signal, run)
        look = {"color": hues[hue % len(hues)], "linestyle": DASHES[dash % len(DASHES)]}
        # samples belong to no run
        made.append({**look, **POINTS, "color": "#404040"} if curve.measured else look)
    return made


def _words(axes: Axes, view: View, letter: float) -> None:
    """What happens, above the first panel, as far as there is room; letter, share of the width that one needs."""
    begin, end = view.begin, view.end
    instants = sorted({event.time for _, event in view.marks})
    shares = [(instant - begin) / (end - begin) for instant in instants]
    taken = 0.0
    for instant, share, following in zip(instants, shares, [*shares, np.inf][1:], strict=True):
        found = list(dict.fromkeys(happened(event) for _, event in view.marks if event.time == instant))
        room = letter * len(found[0]) + 0.01
        # beside its line where another word takes the room; behind it only where it ends before the next one
        left = min(max(share - 0.5 * room, taken), 1.0 - room)
        most = share + BEHIND if following > left + room else share
        if len(found) > 1 or left < taken or left > most:
            continue
        taken = left + room
        axes.annotate(
            found[0], (left + 0.5 * room, 1.0), (0, 2), xycoords="axes fraction", textcoords="offset points",
            ha="center", va="bottom", fontsize=6.5, color="#606060",
        )  # fmt: skip
