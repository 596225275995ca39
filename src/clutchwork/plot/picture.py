"""One picture of a run: speeds, zoom at a lock-up, inputs, torques, locked phases and temperatures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from string import ascii_lowercase
from typing import TYPE_CHECKING

from clutchwork.base import dataclass
from clutchwork.declare.node import Domain
from clutchwork.plot import panels, style
from clutchwork.plot.figure import figure_of, written
from clutchwork.results.events import Event

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from clutchwork.plot.canvas import Picture
    from clutchwork.plot.view import View
    from clutchwork.results.recorded import Recorded


@dataclass(frozen=True)
class AxesPanel:
    """One axes of a picture."""

    title: str
    height: float  # mm
    whole: bool  # over the time of the whole run
    draw: Callable[[Axes], None]


def picture(
    view: View, path: Path | None = None, *, lockup: Event | None = None, width: float = style.WIDTH
) -> Picture:
    """The picture of a run in which nothing is named, and write it where there is a path.

    `lockup` is the event to look at closely, by default the last one in which a contact locks; width [inch].
    """
    (run,) = view.runs.values()
    lockup = lockup or last_lockup(run)
    chosen = _panels(run, lockup)
    height = sum(panel.height + (9.0 if panel.whole else 14.0) for panel in chosen) + 12.0
    # a dollar in a name is a dollar
    with figure_of(height, formulas=False, width=width) as figure:
        _draw(figure, view, lockup, chosen)
        return written(figure, path)


def last_lockup(run: Recorded) -> Event | None:
    """The last event of a run in which a contact locks."""
    locking = [e for e in run.events.changes() if e.after == "locked" and run.time[0] < e.time < run.time[-1]]
    return locking[-1] if locking else None


def _panels(run: Recorded, lockup: Event | None) -> list[AxesPanel]:
    chosen: list[AxesPanel] = []
    for domain, members in ((Domain.ROTATION, "shafts"), (Domain.TRANSLATION, "masses")):
        count = sum(node.domain is domain for node in run.wiring.nodes)
        if count:
            words = f"speeds of {_all(count)} {members}"
            chosen.append(
                AxesPanel(
                    words, _height(min(count, panels.MOST_CURVES)), True, partial(panels.speeds, run=run, domain=domain)
                )
            )
    if lockup is not None:
        chosen.append(AxesPanel("zoom at lock-up", 42.0, False, partial(panels.zoom, run=run, event=lockup)))
    for group in panels.driven(run):
        words = f"{panels.pressing(run, group)}s of {_contacts(run, len(group))}"
        height = _height(len(group), 28.0)
        chosen.append(AxesPanel(words, height, True, partial(panels.inputs, run=run, names=group)))
    for contacts in panels.loaded(run):
        words = f"{panels.carrying(run, contacts)}s of {_contacts(run, len(contacts))}"
        # its legend has a title
        height = _height(len(contacts), 46.0, 5.0)
        chosen.append(AxesPanel(words, height, True, partial(panels.torques, run=run, names=contacts)))
    if panels.busy(run):
        rows = len(panels.busy(run))
        words = f"states of {_contacts(run, rows)}"
        chosen.append(AxesPanel(words, 5.0 + 4.0 * rows, True, partial(panels.locks, run=run)))
    if run.wiring.thermal:
        count = len(run.wiring.thermal)
        words, height = f"temperatures of {_all(count)} thermal nodes", _height(min(count, panels.MOST_CURVES), 36.0)
        chosen.append(AxesPanel(words, height, True, partial(panels.temperatures, run=run)))
    return chosen


def _all(count: int) -> str:
    return "all" if count <= panels.MOST_CURVES else f"the first {panels.MOST_CURVES} of {count}"


def _height(curves: int, least: float = 52.0, title: float = 0.0) -> float:
    """Tall enough for the legend [mm]."""
    rows = -(-curves // -(-curves // panels.MOST_ROWS))
    return max(least, 3.9 * rows + 2.0 + title)


def _contacts(run: Recorded, drawn: int) -> str:
    """Contacts in words, with how many are drawn of those that carry torque, where these are many."""
    count = panels.carriers(run)
    return "clutches and brakes" if count <= panels.MOST_CURVES else f"{drawn} of {count} clutches and brakes"


def _draw(figure: Figure, view: View, lockup: Event | None, chosen: list[AxesPanel]) -> None:
    (run,) = view.runs.values()
    grid = figure.add_gridspec(len(chosen), 1, height_ratios=[panel.height for panel in chosen])
    instants = list(dict.fromkeys(event.time for _, event in view.marks))
    for row, panel in enumerate(chosen):
        axes = figure.add_subplot(grid[row])
        panel.draw(axes)
        # lines at events are upright, and no instants
        if run.time[0] == run.time[-1]:
            panels.dotted(axes.get_lines())
        axes.set_title(f"{ascii_lowercase[row]})  {panel.title}", loc="left")
        if panel.whole:
            axes.set_xlim(view.begin, view.end)
            _mark(axes, instants)
        # one label is enough for panels over the same time
        if row + 1 < len(chosen) and panel.whole and chosen[row + 1].whole:
            axes.tick_params(labelbottom=False)
        else:
            axes.set_xlabel("time, s")
    figure.align_ylabels()
    if lockup is not None:
        _frame(figure, run, lockup, chosen)


def _frame(figure: Figure, run: Recorded, lockup: Event, chosen: list[AxesPanel]) -> None:
    """Show in the panel of all speeds what the zoom is cut from."""
    zoomed = next(row for row, panel in enumerate(chosen) if not panel.whole)
    translates = panels.domain_of(run, lockup) is Domain.TRANSLATION
    panels.frame(figure.axes[zoomed - 1 if translates else 0], run, lockup, ascii_lowercase[zoomed])


def _mark(axes: Axes, instants: Sequence[float]) -> None:
    """Thin lines at events."""
    for instant in instants:
        axes.axvline(instant, **style.EVENT_LINE)
