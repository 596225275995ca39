"""Break-away over the rate of the load."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.rig.bench import Bench, friction, position
from clutchwork.rig.experiment import Experiment, Result, experiment
from clutchwork.rig.looks import head, legend_below, looks, small
from clutchwork.rig.presets import Preset
from clutchwork.rig.table import Table, TableColumn
from clutchwork.rig.trial import NOT_REACHED, Runs, Trial
from clutchwork.signals.table import Table as Course

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from clutchwork.run.trajectory import Trajectory


@experiment
@dataclass(frozen=True)
class Breakaway(Experiment):
    """At what force a body breaks away when the load rises slowly or fast.

    The load on a body at rest rises at a constant rate. The break-away force is the largest friction force while the
    body has moved less than a few elastic deflections. Measured contacts break away earlier under fast loads.

    Source: V. I. Johannes, M. A. Green, C. A. Brockley, Wear 24, 1973, 381-385.
    """

    title = "break-away over the rate of the load"
    usual = ("stribeck", "mykhalevych", "elastoplastic", "gms", "lugre", "dahl")
    preset = "second"
    height = 85.0

    slowest: float = 0.01  # static force per s
    fastest: float = 100.0  # static force per s
    points: int = 9
    reach: float = 10.0  # how far the body may move, over the elastic deflection

    @property
    def rates(self) -> list[float]:
        """Rates of the load [static force per s]."""
        return [float(rate) for rate in np.geomspace(self.slowest, self.fastest, self.points)]

    def run(self, bench: Bench) -> Runs:
        """One run for each rate: up to twice the static force, which is then held."""
        return {f"{rate:.4g}": self._ramp(bench, rate) for rate in self.rates}

    def _ramp(self, bench: Bench, rate: float) -> Trajectory:
        settle = (2.0 * self.reach * bench.preset.length * bench.preset.mass / bench.preset.force) ** 0.5
        load = Course([(0.0, 0.0), (2.0 / rate, 2.0 * bench.preset.force)])
        return bench.simulate(bench.pushed(load), 1.2 / rate + 5.0 * settle, points=4000)

    def table(self, preset: Preset, trials: Mapping[str, Trial]) -> Table:
        """One line for each rate."""
        force = preset.unit_force
        heads = (TableColumn("rate", f"{force}/s"), *(TableColumn(label, force) for label in trials))
        lines = []
        for rate in self.rates:
            peaks = [self.peak(trial[f"{rate:.4g}"], preset) for trial in trials.values()]
            lines.append((rate * preset.force, *peaks))
        return Table(heads, tuple(lines))

    def peak(self, run: Trajectory, preset: Preset) -> float:
        """Largest friction force before the body has moved too far [N]; NaN when it did not get there."""
        near_by = position(run) < self.reach * preset.length
        return float(np.max(friction(run)[near_by])) if not np.all(near_by) else NOT_REACHED

    def draw(self, figure: Figure, result: Result) -> None:
        """Break-away force over the rate, and friction over displacement at the slowest rate."""
        over_rate, course = figure.subplots(1, 2)
        rates, unit = [float(cell) for cell in result.table["rate"]], result.preset.unit_force
        slowest, reach = f"{self.rates[0]:.4g}", self.reach * result.preset.length
        for label, look in looks(result.runs).items():
            over_rate.plot(rates, [float(cell) for cell in result.table[label]], marker=".", markersize=4.0, **look)
            run = result[label, slowest]
            near_by = position(run) < reach
            course.plot(1e6 * position(run)[near_by], friction(run)[near_by], **look)
        head(over_rate, "a", "break-away force")
        over_rate.set_xscale("log")
        over_rate.set_xlabel(f"rate of the load, {unit}/s")
        over_rate.set_ylabel(f"force, {unit}")
        head(course, "b", f"friction at {rates[0]:g} {unit}/s")
        course.set_xlabel(f"displacement, {small(result.preset.unit_length, 1e6)}")
        course.set_ylabel(f"friction, {unit}")
        legend_below(over_rate)
