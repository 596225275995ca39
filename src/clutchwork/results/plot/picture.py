"""One picture of a run: speeds, zoom at a lock-up, inputs, torques and locked phases."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from string import ascii_lowercase
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import UseError
from clutchwork.base.shown import shown
from clutchwork.declare.calls import explained
from clutchwork.declare.node import Domain
from clutchwork.results.events import Event
from clutchwork.results.plot import panels, style
from clutchwork.results.plot.figure import figure_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from clutchwork.results.recorded import Recorded


@dataclass(frozen=True)
class Panel:
    """One axes of a picture."""

    title: str
    height: float  # mm
    whole: bool  # over the time of the whole run
    draw: Callable[[Axes], None]


@explained("plot")
def picture(run: Recorded, path: str | Path | None = None, *, lockup: Event | None = None) -> Figure:
    """Draw a run and write it to `path` (PNG, SVG or PDF by its ending) when given.

    `lockup` is the event to look at closely, by default the last one in which a contact locks.
    """
    if lockup is not None and not isinstance(lockup, Event):
        raise UseError("plot", [f"lockup is {shown(lockup)}: it must be an event, such as run.events.of('c1')[-1]"])
    lockup = lockup or last_lockup(run)
    chosen = _panels(run, lockup)
    height = sum(panel.height + (9.0 if panel.whole else 14.0) for panel in chosen) + 12.0
    # a dollar in a name is a dollar
    with figure_of(height, formulas=False) as figure:
        _draw(figure, run, lockup, chosen)
        if path is not None:
            Path(path).parent.mkdir(parents=True, exist_ok=True)
            figure.savefig(path)
    return figure


def last_lockup(run: Recorded) -> Event | None:
    """The last event of a run in which a contact locks."""
    locking = [e for e in run.events.changes() if e.after == "locked" and run.time[0] < e.time < run.time[-1]]
    return locking[-1] if locking else None


def _panels(run: Recorded, lockup: Event | None) -> list[Panel]:
    chosen: list[Panel] = []
    for domain, members in ((Domain.ROTATION, "shafts"), (Domain.TRANSLATION, "masses")):
        if any(node.domain is domain for node in run.wiring.nodes):
            chosen.append(Panel(f"speeds of all {members}", 52.0, True, partial(panels.speeds, run=run, domain=domain)))
    if lockup is not None:
        chosen.append(Panel("zoom at lock-up", 42.0, False, partial(panels.zoom, run=run, event=lockup)))
    for group in panels.driven(run):
        words = f"{panels.pressing(run, group)}s of clutches and brakes"
        chosen.append(Panel(words, 28.0, True, partial(panels.inputs, run=run, names=group)))
    for contacts in panels.loaded(run):
        words = f"{panels.carrying(run, contacts)}s of clutches and brakes"
        chosen.append(Panel(words, 46.0, True, partial(panels.torques, run=run, names=contacts)))
    if panels.busy(run):
        rows = len(panels.busy(run))
        chosen.append(Panel("states of clutches and brakes", 5.0 + 4.0 * rows, True, partial(panels.locks, run=run)))
    return chosen


def _draw(figure: Figure, run: Recorded, lockup: Event | None, chosen: list[Panel]) -> None:
    grid = figure.add_gridspec(len(chosen), 1, height_ratios=[panel.height for panel in chosen])
    begin, end = float(run.time[0]), float(run.time[-1])
    instants = np.unique(run.events.changes().times)
    for row, panel in enumerate(chosen):
        axes = figure.add_subplot(grid[row])
        panel.draw(axes)
        axes.set_title(f"{ascii_lowercase[row]})  {panel.title}", loc="left")
        if panel.whole:
            axes.set_xlim(begin, end)
            _mark(axes, instants)
        # one label is enough for panels over the same time
        if row + 1 < len(chosen) and panel.whole and chosen[row + 1].whole:
            axes.tick_params(labelbottom=False)
        else:
            axes.set_xlabel("time, s")
    figure.align_ylabels()
    if lockup is not None:
        _frame(figure, run, lockup, chosen)


def _frame(figure: Figure, run: Recorded, lockup: Event, chosen: list[Panel]) -> None:
    """Show in the panel of all speeds what the zoom is cut from."""
    zoomed = next(row for row, panel in enumerate(chosen) if not panel.whole)
    translates = panels.domain_of(run, lockup) is Domain.TRANSLATION
    panels.frame(figure.axes[zoomed - 1 if translates else 0], run, lockup, ascii_lowercase[zoomed])


def _mark(axes: Axes, instants: Any) -> None:
    """Thin lines at events, unless there are so many that they hide the rest."""
    if len(instants) <= 30:
        for instant in instants:
            axes.axvline(instant, **style.EVENT_LINE)
