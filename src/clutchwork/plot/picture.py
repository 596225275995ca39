"""One picture of a run: speeds, zoom at a lock-up, inputs, torques and locked phases."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from string import ascii_lowercase
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.node import Domain
from clutchwork.plot import panels, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from clutchwork.events import Event
    from clutchwork.trajectory import Trajectory

# what is drawn, height in mm, whether its time axis is that of the whole run
Panel = tuple[str, float, bool, Callable[["Axes"], None]]


def picture(run: Trajectory, path: str | Path | None = None, *, lockup: Event | None = None) -> Figure:
    """Draw a run and write it to `path` (PNG, SVG or PDF by its ending) when given.

    `lockup` is the event to look at closely, by default the last one in which a contact locks.
    """
    new_figure, rc_context = _matplotlib()
    with rc_context(style.RC):
        chosen = _panels(run, lockup or last_lockup(run))
        height = sum(panel[1] for panel in chosen) + 16.0 * len(chosen)
        figure: Figure = new_figure(figsize=(style.WIDTH, height * style.MILLIMETRE), layout="constrained")
        _draw(figure, run, chosen)
        if path is not None:
            Path(path).parent.mkdir(parents=True, exist_ok=True)
            figure.savefig(path)
    return figure


def last_lockup(run: Trajectory) -> Event | None:
    """The last event of a run in which a contact locks."""
    locking = [e for e in run.events.changes() if e.after == "locked" and run.time[0] < e.time < run.time[-1]]
    return locking[-1] if locking else None


def _panels(run: Trajectory, lockup: Event | None) -> list[Panel]:
    chosen: list[Panel] = []
    present = {node.domain for node in run.wiring.nodes}
    if Domain.ROTATION in present:
        chosen.append(("speeds of all shafts", 52.0, True, lambda ax: panels.speeds(ax, run, Domain.ROTATION)))
    if Domain.TRANSLATION in present:
        chosen.append(("speeds of all masses", 52.0, True, lambda ax: panels.speeds(ax, run, Domain.TRANSLATION)))
    if lockup is not None:
        chosen.append(("zoom at lock-up", 42.0, False, lambda ax: panels.zoom(ax, run, lockup)))
    if panels.driven(run):
        chosen.append(("pressing of the contacts", 28.0, True, lambda ax: panels.inputs(ax, run)))
    if panels.busy(run):
        chosen.append(("torques of the contacts", 46.0, True, lambda ax: panels.torques(ax, run)))
        rows = len(panels.busy(run))
        chosen.append(("state of the contacts", 4.0 + 4.0 * rows, True, lambda ax: panels.locks(ax, run)))
    return chosen


def _draw(figure: Figure, run: Trajectory, chosen: list[Panel]) -> None:
    grid = figure.add_gridspec(len(chosen), 1, height_ratios=[panel[1] for panel in chosen])
    begin, end = float(run.time[0]), float(run.time[-1])
    instants = np.unique(run.events.changes().times)
    for row, (title, _, whole, draw) in enumerate(chosen):
        axes = figure.add_subplot(grid[row])
        draw(axes)
        axes.set_title(f"{ascii_lowercase[row]})  {title}", loc="left")
        axes.set_xlabel("time, s")
        if whole:
            axes.set_xlim(begin, end)
            _mark(axes, instants)


def _mark(axes: Axes, instants: Any) -> None:
    """Thin lines at events, unless there are so many that they hide the rest."""
    if len(instants) <= 30:
        for instant in instants:
            axes.axvline(instant, **style.EVENT_LINE)


def _matplotlib() -> tuple[Any, Any]:
    try:
        from matplotlib import rc_context
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise ImportError('pictures need matplotlib: pip install "clutchwork[plot]"') from error

    def make(**options: Any) -> Figure:
        figure = Figure(**options)
        FigureCanvasAgg(figure)
        return figure

    return make, rc_context
