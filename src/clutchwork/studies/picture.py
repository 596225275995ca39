"""Pictures of studies: distributions of outputs, Sobol indices as bars."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError
from clutchwork.base.paths import fitting
from clutchwork.plot.chosen import PICTURES
from clutchwork.plot.figure import figure_of
from clutchwork.plot.style import COLOURS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.figure import Figure

    from clutchwork.base.arrays import Array


ROW, BAR, HEAD = 50.0, 7.0, 25.0  # mm
BINS = 60
SHARES = (0.05, 0.5, 0.95)


def distributions(outputs: Mapping[str, NDArray[Any]], units: Mapping[str, str], path: str | Path | None) -> Figure:
    """A histogram of each output, with the median and the limits of nine tenths."""
    shown = {name: one for name, one in outputs.items() if one.dtype.kind == "f" and np.isfinite(one).any()}
    if not shown:
        raise UseError("study.plot", ["nothing to draw: no variant with a number is there"])
    rows = -(-len(shown) // 2)
    with figure_of(ROW * rows) as figure:
        for place, (name, values) in enumerate(shown.items(), 1):
            axes = figure.add_subplot(rows, min(2, len(shown)), place)
            known = values[np.isfinite(values)]
            # values that are the same up to round-off are one bar
            same = np.ptp(known) <= 1e-9 * np.abs(known).max()
            axes.hist(known.round(12) if same else known, bins=1 if same else BINS, color=COLOURS[0])
            for share, value in zip(SHARES, np.quantile(known, SHARES), strict=True):
                axes.axvline(value, color=COLOURS[1], linewidth=0.8, linestyle="-" if share == 0.5 else "--")
            unit = units.get(name, "")
            axes.set_xlabel(f"{name}, {unit}" if unit else name)
            axes.set_ylabel("variants")
        if path is not None:
            figure.savefig(fitting("study.plot", path, "study.png", PICTURES))
    return figure


def indices(
    output: str, names: Sequence[str], total: tuple[Array, Array], first: tuple[Array, Array], path: str | Path | None
) -> Figure:
    """First order and total beside each other with half widths of their intervals, the largest total on top."""
    order = np.argsort(total[0])
    places = np.arange(len(order))
    with figure_of(HEAD + BAR * len(order)) as figure:
        axes = figure.add_subplot()
        bars = ((0.2, *total, "total", COLOURS[0]), (-0.2, *first, "first order", COLOURS[1]))
        for shift, index, width, label, colour in bars:
            lines = {"ecolor": "black", "elinewidth": 0.8}
            axes.barh(places + shift, index[order], 0.38, xerr=width[order], color=colour, label=label, error_kw=lines)
        axes.set_yticks(places, [names[place] for place in order.tolist()])
        axes.set_xlim(left=0.0)
        axes.set_xlabel(f"share of the variance of {output}")
        axes.legend(loc="lower right")
        if path is not None:
            figure.savefig(fitting("sobol_indices.plot", path, "indices.png", PICTURES))
    return figure
