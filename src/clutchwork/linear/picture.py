"""Picture of a linear system: its eigenvalues, and how the shafts move in its modes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base.paths import fitting
from clutchwork.plot.chosen import PICTURES
from clutchwork.plot.figure import figure_of
from clutchwork.plot.style import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from clutchwork.linear.modes import NaturalMode
    from clutchwork.linear.system import LinearSystem

STABLE, GROWING = COLOURS[0], COLOURS[1]
PANEL = 24.0  # mm
LEAST_HEIGHT = 62.0  # mm
MOST_MODES, MOST_SHAFTS = 6, 24


def picture(lin: LinearSystem, path: str | Path | None = None) -> Figure:
    """Eigenvalues on the left, shapes of the slowest oscillating modes on the right; written to `path` when given."""
    shapes = [mode for mode in lin.modes.swinging if mode.shape][:MOST_MODES]
    shapes = shapes or [mode for mode in lin.modes if mode.shape][:MOST_MODES]
    with figure_of(max(LEAST_HEIGHT, 14.0 + PANEL * len(shapes)), formulas=False) as figure:
        rows = max(1, len(shapes))
        grid = figure.add_gridspec(rows, 2, width_ratios=[0.8, 1.2])
        _eigenvalues(figure.add_subplot(grid[:, 0]), lin)
        first: Axes | None = None
        for place, mode in enumerate(shapes):
            axes = figure.add_subplot(grid[place, 1], sharex=first)
            first = first or axes
            _shape(axes, mode, last=place == rows - 1)
        if path is not None:
            figure.savefig(fitting("plot", path, "modes.png", PICTURES))
    return figure


def _eigenvalues(axes: Axes, lin: LinearSystem) -> None:
    """Real parts over frequencies; what is right of the line grows."""
    values = lin.eigenvalues
    colours = [GROWING if value.real > 0.0 else STABLE for value in values]
    axes.axvline(0.0, color="#9A9A9A", linewidth=0.8, zorder=1)
    axes.scatter(values.real, values.imag / (2.0 * np.pi), marker="x", c=colours, s=28, linewidths=1.3, zorder=3)
    axes.set_xlabel("real part [1/s]")
    axes.set_ylabel("frequency [Hz]")
    axes.set_title("eigenvalues", loc="left")
    reach = max(float(np.abs(values.imag).max(initial=0.0)) / (2.0 * np.pi), 1e-3)
    axes.set_ylim(-1.15 * reach, 1.15 * reach)
    # a mode that is far faster than the others would press all of them onto the line
    swinging = np.abs(values.real[np.abs(values.imag) > 0.0])
    slow = values.real if not swinging.size else values.real[np.abs(values.real) <= 20.0 * swinging.max() + 1.0]
    least, most = float(slow.min(initial=0.0)), float(slow.max(initial=0.0))
    margin = 0.12 * max(most - least, 0.1)
    axes.set_xlim(least - margin, most + margin)
    hidden = len(values) - len(slow)
    if hidden:
        axes.set_title(f"eigenvalues ({hidden} faster, left out)", loc="left")


def _shape(axes: Axes, mode: NaturalMode, *, last: bool) -> None:
    """Amplitude of each shaft as a bar, below zero where it moves against the one that moves most."""
    names = list(mode.shape)[:MOST_SHAFTS]
    values = np.array([mode.shape[name] for name in names])
    signed = np.abs(values) * np.where(values.real < 0.0, -1.0, 1.0)
    axes.bar(np.arange(len(names)), signed, width=0.6, color=GROWING if mode.eigenvalue.real > 0.0 else STABLE)
    axes.axhline(0.0, color="#404040", linewidth=0.6)
    axes.set_ylim(-1.15, 1.15)
    axes.grid(visible=False, axis="x")
    words = f"{mode.frequency:.3g} Hz, damping {100.0 * mode.damping:.2g} %"
    axes.set_title(words if mode.frequency > 0.0 else f"{mode.kind}, {mode.time_constant:.3g} s", loc="left")
    axes.set_xticks(np.arange(len(names)), names if last else [""] * len(names))
    if last and max(map(len, names)) * len(names) > 60:
        axes.tick_params(axis="x", rotation=60)
    elif not last:
        axes.tick_params(axis="x", labelbottom=False)
