"""Picture of a fit: measured and fitted torque, and what is left over."""

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

    from clutchwork.fit.fitted_law import FittedLaw

MEASURED, FITTED, BOUND = COLOURS[0], COLOURS[1], COLOURS[7]
HEIGHT = 135.0  # mm


def picture(result: FittedLaw, path: str | Path | None = None) -> Figure:
    """Torque over time and slip, residuals over slip and their distribution; written to `path` when given."""
    with figure_of(HEIGHT) as figure:
        grid = figure.add_gridspec(3, 2, height_ratios=[1.0, 1.0, 0.8])
        over_time(figure.add_subplot(grid[0, :]), result)
        over_slip(figure.add_subplot(grid[1, :]), result)
        residuals(figure.add_subplot(grid[2, 0]), result)
        distribution(figure.add_subplot(grid[2, 1]), result)
        for axes, letter in zip(figure.axes, "abcd", strict=True):
            axes.set_title(f"{letter})  {axes.get_title()}", loc="left")
            axes.set_title("")
        if path is not None:
            figure.savefig(fitting("plot", path, "fit.png", PICTURES))
    return figure


def over_time(axes: Axes, result: FittedLaw) -> None:
    """Measured samples as points, the fitted law as a line."""
    samples = result.samples
    axes.plot(samples.time, samples.torque, ".", color=MEASURED, markersize=2.5, label="measured")
    axes.plot(samples.time, result.fitted, color=FITTED, linewidth=0.9, label="fitted")
    axes.set_title(f"{type(result.law).__name__} law, rms {result.rms:.3g} {_units(result)[1]}")
    axes.set_xlabel("time, s")
    axes.set_ylabel(f"torque, {_units(result)[1]}")
    _legend(axes)


def over_slip(axes: Axes, result: FittedLaw) -> None:
    """Torque over slip; samples at rest, which give only a bound, in grey."""
    samples, counts = result.samples, result.equations
    axes.plot(samples.slip[counts], samples.torque[counts], ".", color=MEASURED, markersize=2.5, label="measured")
    if not np.all(counts):
        axes.plot(
            samples.slip[~counts], samples.torque[~counts], ".", color=BOUND, markersize=2.5, label="at rest: a bound"
        )
    axes.plot(samples.slip[counts], result.fitted[counts], ".", color=FITTED, markersize=1.5, label="fitted")
    axes.set_title("torque over slip")
    axes.set_xlabel(f"slip, {_units(result)[0]}")
    axes.set_ylabel(f"torque, {_units(result)[1]}")
    _legend(axes)


def residuals(axes: Axes, result: FittedLaw) -> None:
    """What is left over, which should have no shape."""
    counts = result.equations
    axes.axhline(0.0, color="#B0B0B0", linewidth=0.6)
    axes.plot(result.samples.slip[counts], result.residuals[counts], ".", color=MEASURED, markersize=2.0)
    axes.set_title("fitted minus measured")
    axes.set_xlabel(f"slip, {_units(result)[0]}")
    axes.set_ylabel(f"residual, {_units(result)[1]}")


def distribution(axes: Axes, result: FittedLaw) -> None:
    """Histogram of the residuals beside the normal distribution of the same width."""
    left = result.residuals[result.equations]
    axes.hist(left, bins=min(40, 5 + len(left) // 10), density=True, color=MEASURED, alpha=0.5)
    if result.rms > 0.0:
        x = np.linspace(-4.0 * result.rms, 4.0 * result.rms, 121)
        bell = np.exp(-0.5 * (x / result.rms) ** 2) / (result.rms * np.sqrt(2.0 * np.pi))
        axes.plot(x, bell, color=FITTED, label="normal")
        axes.legend(loc="upper right")
    axes.locator_params(axis="x", nbins=5)
    axes.set_title("distribution of the residuals")
    axes.set_xlabel(f"residual, {_units(result)[1]}")
    axes.set_ylabel(f"density, 1/({_units(result)[1]})")


def _legend(axes: Axes) -> None:
    """Above the axes, where it covers nothing."""
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=3, borderaxespad=0.0, handletextpad=0.2)


def _units(result: FittedLaw) -> tuple[str, str]:
    return ("m/s", "N") if result.samples.translation else ("rad/s", "N m")
