"""Panels over time, one below the other, in the look of the package."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from string import ascii_lowercase
from typing import TYPE_CHECKING, NamedTuple

import clutchwork as cw
from clutchwork.plot.figure import figure_of
from clutchwork.plot.panels import legend
from clutchwork.plot.style import EVENT_LINE

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Panel(NamedTuple):
    """One axes: its title, the label of its values, and what is drawn in it."""

    title: str
    label: str
    draw: Callable[[Axes], None]


def draw(path: Path, run: cw.Trajectory, panels: Iterable[Panel], marks: Iterable[float] = ()) -> None:
    """Draw the panels, with thin lines at the marked times [s], and write the picture."""
    panels, marks = list(panels), list(marks)
    with figure_of(38.0 * len(panels) + 10.0) as figure:
        all_axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        for letter, axes, panel in zip(ascii_lowercase, all_axes, panels, strict=False):
            panel.draw(axes)
            axes.set_title(f"{letter})  {panel.title}", loc="left")
            axes.set_ylabel(panel.label)
            axes.margins(y=0.06)
            for mark in marks:
                axes.axvline(mark, **EVENT_LINE)
            legend(axes)
        all_axes[-1].set_xlim(float(run.time[0]), float(run.time[-1]))
        all_axes[-1].set_xlabel("time, s")
        figure.align_ylabels()
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path)
