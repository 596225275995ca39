"""What `run.plot` draws, and what a notebook shows of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from clutchwork.base import UseError, counted, html, quote
from clutchwork.plot import named
from clutchwork.plot.chosen import PICTURES, PanelRequest, PlotArguments, asked, panels, usual_groups, wide
from clutchwork.plot.curves import panels_of, units_of
from clutchwork.plot.measured import samples, with_samples
from clutchwork.plot.panels import busy
from clutchwork.plot.picture import picture
from clutchwork.plot.view import View, viewed
from clutchwork.results.events import Event

if TYPE_CHECKING:
    from clutchwork.plot.canvas import Picture
    from clutchwork.results.recorded import Recorded


def plot(run: Recorded, chosen: PlotArguments, lockup: Event | None = None) -> Picture:
    """Draw a run: what is named, or the usual panels."""
    runs = {"": run}
    wanted = asked("plot", chosen.signals, chosen.path, PICTURES, run.channels)
    extra, shown_in = samples(runs, chosen.measured, "plot"), units_of(runs, chosen.units, "plot")
    if shown_in.units and not wanted.groups and chosen.unit is None:
        # panels of their own, for members of one may have several units
        states = tuple((False, (f"{contact}.state",)) for contact in busy(run))
        wanted = PanelRequest((*usual_groups(run), *states), wanted.path)
    groups = with_samples(panels(runs, wanted, chosen.unit, "plot"), extra)
    _check_lockup(lockup, bool(groups))
    view = viewed(runs, chosen.zoom, chosen.events, "plot")
    if groups:
        shown = panels_of(view.runs, groups, extra, "plot", shown_in)
        return named.draw(view, shown, wanted.path, "signal", wide(chosen.width, "plot"))
    _check_inside(lockup, view, chosen.zoom)
    return picture(view, wanted.path, lockup=lockup, width=wide(chosen.width, "plot"))


def _check_lockup(lockup: object, is_named: bool) -> None:
    if lockup is None:
        return
    if not isinstance(lockup, Event):
        raise UseError("plot", [f"lockup is {quote(lockup)}: it must be an event, such as run.events.of('c1')[-1]"])
    if is_named:
        remedy = "give zoom=(t0, t1), or leave out the names"
        raise UseError("plot", [f"lockup is of the picture without names of signals; {remedy}"])


def _check_inside(lockup: Event | None, view: View, zoom: object) -> None:
    if lockup is not None and zoom is not None and not view.begin <= lockup.time <= view.end:
        fault = f"lockup is at {lockup.time:g} s, outside of the zoom from {view.begin:g} to {view.end:g} s"
        raise UseError("plot", [f"{fault}; leave out one of them"])


def parts(run: Any) -> tuple[Picture | None, list[str]]:
    """The picture and the tables of a run in a notebook; no picture without matplotlib."""
    tables = [_summary(run)]
    try:
        return (plot(run, PlotArguments()) if len(run) else None), tables
    except ImportError:
        return None, tables


def _summary(run: Any) -> str:
    """What a run is, in one table."""
    lines = [("run of", run.system.name), ("status", run.status)]
    lines += [("message", run.message)] if run.message else []
    if len(run):
        lines.append(("time", f"{run.time[0]:g} to {run.time[-1]:g} s, {counted(len(run), 'instants')}"))
    statistics = run.statistics
    steps, seconds = int(statistics.get("steps", 0)), float(statistics.get("core_seconds", 0.0))
    lines.append(("effort", f"{counted(steps, 'steps')}, {1e3 * seconds:.3g} ms"))
    lines.append(("holds", f"{counted(len(run.names), 'signals')}, {counted(len(run.events), 'events')}"))
    if len(run) and run.options.work:
        energy = run.energy
        share = abs(energy.residual) / energy.turnover if energy.turnover else 0.0
        lines.append(("heat of contacts and dampers", f"{sum(energy.heat.values()):z.4g} J"))
        lines.append(("residual of the energy balance", f"{energy.residual:.2e} J, {share:.0e} of the turnover"))
    return html.table(("", ""), lines)
