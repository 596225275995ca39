"""Frictional lag."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.rig.bench import Bench, friction, speed
from clutchwork.rig.experiment import Experiment, Result, experiment
from clutchwork.rig.looks import GREY, head, legend_below, looks, small
from clutchwork.rig.presets import Preset
from clutchwork.rig.table import TableColumn
from clutchwork.rig.trial import Runs, Trial
from clutchwork.signals.sine import Sine

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from clutchwork.run.trajectory import Trajectory

CASES = ("slow", "fast")


@experiment
@dataclass(frozen=True)
class Lag(Experiment):
    """Whether friction follows the speed at once, or late.

    A body slides in one direction with a speed that oscillates around a mean. Measured friction is larger while the
    speed rises than while it falls, so that it runs through a loop; a law without states stays on its curve.

    Source: D. P. Hess, A. Soom, Journal of Tribology 112, 1990, 147-152.
    """

    title = "frictional lag in sliding"
    usual = ("gms", "lugre", "elastoplastic", "mykhalevych", "stribeck")
    preset = "second"
    height = 85.0

    middle: float = 1.0  # mean speed over the Stribeck speed
    swing: float = 0.8  # amplitude over the Stribeck speed, less than the mean
    slow: float = 1.0  # Hz
    fast: float = 20.0  # Hz
    settle: float = 1.0  # s at least before the cycle that counts
    samples: int = 400  # in that cycle

    def run(self, bench: Bench) -> Runs:
        """One run for each frequency; its samples are those of the last cycle."""
        return {case: self._cycle(bench, getattr(self, case)) for case in CASES}

    def _cycle(self, bench: Bench, hertz: float) -> Trajectory:
        begin, unit = ceil(self.settle * hertz) / hertz, bench.preset.speed
        motion = Sine(amplitude=self.swing * unit, frequency=hertz, offset=self.middle * unit)
        times = begin + np.linspace(0.0, 1.0 / hertz, self.samples + 1)
        return bench.simulate(bench.moved(motion, start=self.middle * unit), float(times[-1]), times=times)

    def columns(self, preset: Preset) -> tuple[TableColumn, ...]:
        """What is measured."""
        return tuple(TableColumn(f"gap at {hertz:g} Hz", preset.unit_force) for hertz in (self.slow, self.fast))

    def measure(self, trial: Trial) -> Sequence[float]:
        """Friction at the mean speed while the speed rises less that while it falls [N]."""
        return [_gap(friction(trial[case])) for case in CASES]

    def draw(self, figure: Figure, result: Result) -> None:
        """Friction over speed at both frequencies, the steady curve in grey."""
        for axes, case, letter in zip(figure.subplots(1, 2, sharey=True), CASES, "ab", strict=True):
            v = np.linspace(self.middle - self.swing, self.middle + self.swing, 200) * result.preset.speed
            axes.plot(1e3 * v, [result.preset.curve(x) for x in v], label="Stribeck curve", **GREY)
            for label, look in looks(result.runs).items():
                axes.plot(1e3 * speed(result[label, case]), friction(result[label, case]), **look)
            head(axes, letter, f"{getattr(self, case):g} Hz")
            axes.set_xlabel(f"speed, {small(result.preset.unit_speed, 1e3)}")
            if letter == "a":
                axes.set_ylabel(f"friction, {result.preset.unit_force}")
        legend_below(figure.axes[0])


def _gap(force: np.ndarray) -> float:
    """The cycle begins at the mean speed, rising; it passes it again in the middle, falling."""
    return float(force[0] - force[len(force) // 2])
