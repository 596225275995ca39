"""Steady friction over speed."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.rig.bench import Bench, friction
from clutchwork.rig.experiment import Experiment, Result, experiment
from clutchwork.rig.looks import GREY, legend_below, nested
from clutchwork.rig.presets import Preset
from clutchwork.rig.table import Table, TableColumn
from clutchwork.rig.trial import NOT_REACHED, Runs, Trial
from clutchwork.signals.table import Table as Course

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from clutchwork.run.trajectory import Trajectory


@experiment
@dataclass(frozen=True)
class Steady(Experiment):
    """The friction that a contact settles to at constant speed.

    The speed rises in steps, each of them held until the contact has slipped far enough to forget the step. Use it to
    see the Stribeck curve that a law really has, its viscous part included.
    """

    title = "steady friction over speed"
    usual = ("stribeck", "lugre", "gms", "mykhalevych", "regularised_stribeck", "tanh")
    height = 85.0

    slowest: float = 0.03  # share of the Stribeck speed
    fastest: float = 30.0  # share of the Stribeck speed
    points: int = 25
    slip: float = 100.0  # slip at every speed over the elastic deflection
    hold: float = 0.5  # s, shortest time at one speed
    ramp: float = 0.01  # s from one speed to the next

    @cached_property
    def shares(self) -> NDArray[np.float64]:
        """The speeds as shares of the Stribeck speed."""
        return np.geomspace(self.slowest, self.fastest, self.points)

    def run(self, bench: Bench) -> Runs:
        """One run through all speeds, with one sample at the end of each."""
        corners, ends = self.course(bench.preset)
        return {"steady": bench.simulate(bench.moved(Course(corners)), float(ends[-1]), times=ends)}

    def course(self, preset: Preset) -> tuple[list[tuple[float, float]], NDArray[np.float64]]:
        """Corners of the speed over time, and the ends of the times at constant speed [s]."""
        speeds = [0.0, *(float(share) * preset.speed for share in self.shares)]
        corners, ends, t = [(0.0, 0.0)], [], 0.0
        for _, speed in pairwise(speeds):
            held = max(self.hold, self.slip * preset.length / speed)
            corners += [(t + self.ramp, speed), (t + self.ramp + held, speed)]
            t += self.ramp + held
            ends.append(t)
        return corners, np.array(ends)

    def table(self, preset: Preset, trials: Mapping[str, Trial]) -> Table:
        """One line for each speed: the Stribeck curve of the preset, then every law."""
        speeds = [float(share) * preset.speed for share in self.shares]
        forces = {label: _reached(trial["steady"], len(speeds)) for label, trial in trials.items()}
        force = preset.unit_force
        heads = (
            TableColumn("speed", preset.unit_speed),
            TableColumn("curve", force),
            *(TableColumn(label, force) for label in forces),
        )
        lines = [(v, preset.curve(v), *(column[i] for column in forces.values())) for i, v in enumerate(speeds)]
        return Table(heads, tuple(lines))

    def draw(self, figure: Figure, result: Result) -> None:
        """All laws over the logarithm of speed, the curve of the preset in grey behind them."""
        axes = figure.subplots()
        speeds = [float(cell) for cell in result.table["speed"]]
        axes.plot(speeds, [float(cell) for cell in result.table["curve"]], label="Stribeck curve", **GREY)
        for label, look in nested(result.runs).items():
            axes.plot(speeds, [float(cell) for cell in result.table[label]], **look)
        axes.set_xscale("log")
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel(f"slip speed, {result.preset.unit_speed}")
        axes.set_ylabel(f"steady friction, {result.preset.unit_force}")
        legend_below(axes)


def _reached(run: Trajectory, count: int) -> list[float]:
    """Friction at all speeds; NaN at those that a run did not reach."""
    force = [float(value) for value in friction(run)]
    return (force + [NOT_REACHED] * count)[:count]
