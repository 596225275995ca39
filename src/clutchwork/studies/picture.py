"""Pictures of studies: distributions of outputs, Sobol indices as bars."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base.errors import UseError
from clutchwork.base.paths import fitting
from clutchwork.plot.chosen import PICTURES
from clutchwork.plot.figure import figure_of
from clutchwork.plot.style import COLOURS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure

    from clutchwork.studies.recorded import Indices, RecordedStudy

ROW, BAR, HEAD = 50.0, 7.0, 25.0  # mm
BINS = 60
SHARES = (0.05, 0.5, 0.95)


def distributions(study: RecordedStudy, names: Sequence[str], path: str | Path | None) -> Figure:
    """A histogram of each output, with the median and the limits of nine tenths."""
    shown = [name for name in names if study[name].dtype.kind == "f" and np.isfinite(study[name]).any()]
    if not shown:
        raise UseError("study.plot", ["nothing to draw: no variant with a number is there"])
    rows = -(-len(shown) // 2)
    with figure_of(ROW * rows) as figure:
        for place, name in enumerate(shown, 1):
            axes = figure.add_subplot(rows, min(2, len(shown)), place)
            values = study[name]
            known = values[np.isfinite(values)]
            # values that are the same but for round-off are one bar
            same = np.ptp(known) <= 1e-9 * np.abs(known).max()
            axes.hist(known.round(12) if same else known, bins=1 if same else BINS, color=COLOURS[0])
            for share, value in zip(SHARES, np.quantile(known, SHARES), strict=True):
                axes.axvline(value, color=COLOURS[1], linewidth=0.8, linestyle="-" if share == 0.5 else "--")
            unit = study.units.get(name, "")
            axes.set_xlabel(f"{name}, {unit}" if unit else name)
            axes.set_ylabel("variants")
        if path is not None:
            figure.savefig(fitting("study.plot", path, "study.png", PICTURES))
    return figure


def indices(found: Indices, path: str | Path | None) -> Figure:
    """First order and total beside each other, the largest total on top."""
    order = np.argsort(found.total)
    places = np.arange(len(order))
    with figure_of(HEAD + BAR * len(order)) as figure:
        axes = figure.add_subplot()
        bars = (
            (0.2, found.total, found.total_interval, "total", COLOURS[0]),
            (-0.2, found.first, found.first_interval, "first order", COLOURS[1]),
        )
        for shift, index, width, label, colour in bars:
            lines = {"ecolor": "black", "elinewidth": 0.8}
            axes.barh(places + shift, index[order], 0.38, xerr=width[order], color=colour, label=label, error_kw=lines)
        axes.set_yticks(places, [found.names[place] for place in order.tolist()])
        axes.set_xlim(left=0.0)
        axes.set_xlabel(f"share of the variance of {found.output}")
        axes.legend(loc="lower right")
        if path is not None:
            figure.savefig(fitting("sobol_indices.plot", path, "indices.png", PICTURES))
    return figure
