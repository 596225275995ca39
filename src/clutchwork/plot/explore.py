"""A picture to zoom into and to hover over, drawn by plotly."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import UseError, quote
from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.base.writing import replaced
from clutchwork.plot.chosen import PAGES, PanelRequest, PlotArguments, asked, panels, usual_groups
from clutchwork.plot.curves import WORDS, Curve, Panel, Side, panels_of, thinned, units_of
from clutchwork.plot.measured import samples, with_samples
from clutchwork.plot.named import curve_looks
from clutchwork.plot.style import DASHES
from clutchwork.plot.view import View, happened, viewed

if TYPE_CHECKING:
    from clutchwork.results.events import Event
    from clutchwork.results.recorded import Recorded

# beyond so many points a browser draws them on the graphics card
MOST_IN_SVG = 100_000
LINE_STYLES = ("solid", "dash", "dot", "longdashdot", "dashdot")
HEIGHT, ROW, MARGINS = 230, 16, 130  # px of a panel, of a line of events, around all
MARKS = {"locked": "square", "open": "circle-open", "forward": "triangle-right", "backward": "triangle-left"}
FEWEST = 100


def explore(run: Recorded, chosen: PlotArguments, points: int | None) -> Any:
    """A figure of plotly with the same panels as `plot`; written as a page where there is a path."""
    runs, call = {"": run}, "explore"
    _check_points(points)
    wanted = asked(call, chosen.signals, chosen.path, PAGES, run.channels)
    extra, shown_in = samples(runs, chosen.measured, call), units_of(runs, chosen.units, call)
    if not wanted.groups and chosen.unit is None and not extra:
        wanted = PanelRequest(usual_groups(run), wanted.path)
    groups = with_samples(panels(runs, wanted, chosen.unit, call), extra)
    view = viewed(runs, chosen.zoom, chosen.events, call)
    figure = _figure(view, panels_of(view.runs, groups, extra, call, shown_in), points)
    if wanted.path is not None:
        # with all that it needs, so that it opens without a network
        with replaced(wanted.path) as new:
            figure.write_html(str(new), include_plotlyjs=True, include_mathjax=False, config=CONFIG)
    return figure


CONFIG: dict[str, Any] = {"displaylogo": False, "scrollZoom": True, "responsive": True}


def _check_points(points: object) -> None:
    if points is None or (isinstance(points, int) and not isinstance(points, bool) and points >= FEWEST):
        return
    remedy = f"give a whole number of at least {FEWEST}, or None for all of them"
    raise UseError("explore", [f"points is {quote(points)}: {remedy}"])


def _figure(view: View, panels: Sequence[Panel], points: int | None) -> Any:
    graph = need("plotly.graph_objects", "interactive", "explore")
    subplots = need("plotly.subplots", "interactive", "explore")
    contacts = list(dict.fromkeys(event.element for _, event in view.marks))
    heights = [HEIGHT] * len(panels) + ([ROW * len(contacts) + 30] if contacts else [])
    figure = subplots.make_subplots(
        rows=len(heights), cols=1, shared_xaxes=True, vertical_spacing=24.0 / sum(heights),
        row_heights=[height / sum(heights) for height in heights],
        specs=[[{"secondary_y": row < len(panels) and len(panels[row].sides) > 1}] for row in range(len(heights))],
    )  # fmt: skip
    drawn = [(row, number, side, curve) for row, panel in enumerate(panels, 1)
             for number, side in enumerate(panel.sides) for curve in side.curves]  # fmt: skip
    looks = [look for panel in panels for look in curve_looks(panel.curves, list(view.runs), "signal")]
    lines = [thinned(curve.time, side.factor * curve.values, points or len(curve.time)) for *_, side, curve in drawn]
    many = sum(len(time) for time, _ in lines) > MOST_IN_SVG
    sort = graph.Scattergl if many else graph.Scatter
    for (row, number, side, curve), look, (time, values) in zip(drawn, looks, lines, strict=True):
        trace = sort(x=time, y=values, **_trace(curve, side, look, row, values, not many))
        figure.add_trace(trace, row=row, col=1, secondary_y=bool(number))
    for row, panel in enumerate(panels, 1):
        for number, side in enumerate(panel.sides):
            look = {"title_text": plain(side.label), "showgrid": not number, "tickmode": "auto", **_ticks(side)}
            figure.update_yaxes(row=row, col=1, secondary_y=bool(number), **look)
    if contacts:
        _events(figure, graph, view, contacts, len(heights))
    _layout(figure, view, sum(heights) + MARGINS, len(heights))
    return figure


def plain(words: str) -> str:
    """Words in which nothing is a tag, a formula or a place for a number."""
    return escape(words).replace("$", "&#36;").replace("%", "&#37;")


def _trace(curve: Curve, side: Side, look: dict[str, Any], row: int, values: Array, dashed: bool) -> dict[str, Any]:
    """Name, colour and what is shown under the pointer: value and unit."""
    unit = "" if side.unit in ("1", "") else f" {plain(side.unit)}"
    value = "%{text}" if side.words else f"%{{y:.6g}}{unit}"
    made: dict[str, Any] = {
        "name": plain(curve.label), "legend": "legend" if row == 1 else f"legend{row}",
        "hovertemplate": f"{plain(curve.label)}: {value}<extra></extra>",
    }  # fmt: skip
    if side.words:
        made["text"] = [side.words.get(code, "") for code in values.tolist()]
    if curve.measured:
        return made | {"mode": "markers", "marker": {"color": look["color"], "size": 4, "opacity": 0.65}}
    dash = LINE_STYLES[DASHES.index(look["linestyle"])] if look["linestyle"] in DASHES else LINE_STYLES[3]
    # a graphics card draws dashes of curves with many points as noise
    line = {"color": look["color"], "width": 1.6, "dash": dash if dashed else "solid"}
    if dashed:
        # else corners are left out that show when zoomed
        line["simplify"] = False
    # a line over a single instant would not be seen
    mode = "lines" if np.ptp(curve.time) else "lines+markers"
    return made | {"mode": mode, "line": line}


def _ticks(side: Side) -> dict[str, Any]:
    words = side.words
    return {"tickmode": "array", "tickvals": list(words), "ticktext": list(words.values())} if words else {}


def _events(figure: Any, graph: Any, view: View, contacts: Sequence[str], row: int) -> None:
    """A line of marks for each contact, with what happened under the pointer; thin lines through all panels."""
    for after, symbol in MARKS.items():
        events = [event for _, event in view.marks if event.after == after]
        if events:
            trace = graph.Scatter(
                x=[event.time for event in events], y=[contacts.index(event.element) for event in events],
                mode="markers", marker={"symbol": symbol, "size": 10, "color": "#404040"}, showlegend=False,
                text=[_told(event, view) for event in events], hovertemplate="%{text}<extra></extra>",
            )  # fmt: skip
            figure.add_trace(trace, row=row, col=1)
    names = [plain(name) or "all" for name in contacts]
    figure.update_yaxes(
        title_text="events", tickvals=list(range(len(names))), ticktext=names, range=[len(names) - 0.4, -0.6],
        fixedrange=True, row=row, col=1,
    )  # fmt: skip
    thin = {"color": "#B0B0B0", "width": 1, "dash": "dot"}
    times = sorted({event.time for _, event in view.marks})
    figure.update_layout(
        shapes=[
            {"type": "line", "x0": t, "x1": t, "y0": 0, "y1": 1, "xref": "x", "yref": "paper", "line": thin,
             "layer": "below"}
            for t in times
        ]
    )  # fmt: skip


def _told(event: Event, view: View) -> str:
    """What happened, and the torque or force before and after."""
    words = f"{happened(event)} at {event.time:.6f} s: {event.cause}"
    run = next(iter(view.runs.values()))
    if event.element:
        unit = run.channels[f"{event.element}.torque"].unit
        words += f", {WORDS[unit]} {event.torque_before:.6g} to {event.torque_after:.6g} {unit}"
    return plain(words)


def _layout(figure: Any, view: View, height: float, rows: int) -> None:
    """One time for all panels, a legend beside each."""
    spike = {
        "showspikes": True,
        "spikemode": "across",
        "spikethickness": 1,
        "spikecolor": "#909090",
        "spikedash": "dot",
    }
    figure.update_xaxes(range=[view.begin, view.end], gridcolor="#E4E4E4", zeroline=False, **spike)
    figure.update_xaxes(matches="x", hoverformat=".6f")
    figure.update_xaxes(title_text="time, s", row=rows, col=1)
    figure.update_yaxes(gridcolor="#E4E4E4", zeroline=False)
    legends: dict[str, Any] = {}
    for row in range(1, rows + 1):
        top = figure.get_subplot(row, 1)
        domain = (top[0] if isinstance(top, list | tuple) and not hasattr(top, "yaxis") else top).yaxis.domain
        legends["legend" if row == 1 else f"legend{row}"] = {"y": float(np.max(domain)), "yanchor": "top", "x": 1.03}
    figure.update_layout(
        height=height, hovermode="x unified", plot_bgcolor="white", margin={"l": 80, "r": 30, "t": 40, "b": 60},
        font={"family": "sans-serif", "size": 12}, dragmode="zoom", **legends,
    )  # fmt: skip
