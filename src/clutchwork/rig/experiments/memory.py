"""Minor loops before sliding."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from string import ascii_lowercase
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.rig.bench import Bench, friction, position
from clutchwork.rig.experiment import Experiment, Result, experiment
from clutchwork.rig.looks import head, legend_below, looks, small, title
from clutchwork.rig.presets import Preset
from clutchwork.rig.table import TableColumn
from clutchwork.rig.trial import Runs, Trial
from clutchwork.signals.table import Table as Course

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from clutchwork.run.trajectory import Trajectory


@experiment
@dataclass(frozen=True)
class Memory(Experiment):
    """Whether a contact remembers its earlier reversals.

    Before sliding, a body is moved along a large loop; on the way up it turns back and returns, which makes a minor
    loop. With non-local memory the minor loop closes, and the force goes on as if it had never been.

    Source: J. Swevers, F. Al-Bender, C. Ganseman, T. Prajogo 2000, doi:10.1109/9.847103.
    """

    title = "minor loops before sliding"
    usual = ("gms", "leuven", "mykhalevych", "elastoplastic", "lugre", "dahl")
    height = 60.0
    across = 3

    outer: float = 1.5  # where the large loop turns, over the elastic deflection
    upper: float = 0.6  # where the minor loop begins and ends
    lower: float = -0.4  # where it turns
    leg: float = 2.0  # s from one turn to the next
    samples: int = 200  # per leg

    def run(self, bench: Bench) -> Runs:
        """The path with the minor loop, and the same without."""
        outer, upper, lower = self.outer, self.upper, self.lower
        paths = {"minor": (outer, -outer, upper, lower, upper, outer), "large": (outer, -outer, upper, outer)}
        return {case: self._path(bench, turns) for case, turns in paths.items()}

    def _path(self, bench: Bench, turns: Sequence[float]) -> Trajectory:
        """Move from turn to turn, at rest at each: the speed is a triangle over each leg."""
        corners, length = [(0.0, 0.0)], bench.preset.length
        for number, (here, there) in enumerate(pairwise((0.0, *turns))):
            peak = 2.0 * (there - here) * length / self.leg
            corners += [((number + 0.5) * self.leg, peak), ((number + 1.0) * self.leg, 0.0)]
        t_end = len(turns) * self.leg
        times = np.linspace(0.0, t_end, len(turns) * self.samples + 1)
        return bench.simulate(bench.moved(Course(corners)), t_end, times=times)

    def columns(self, preset: Preset) -> tuple[TableColumn, ...]:
        """What is measured."""
        names = ("minor loop open by", "forgotten by", "creep of the large loop")
        return tuple(TableColumn(name, preset.unit_force) for name in names)

    def measure(self, trial: Trial) -> Sequence[float]:
        """Change of force over the minor loop, and what is left of that at the end of the large one [N]."""
        minor, large = friction(trial["minor"]), friction(trial["large"])
        n = self.samples
        return float(minor[5 * n] - minor[3 * n]), float(minor[6 * n] - large[4 * n]), float(large[4 * n] - large[n])

    def draw(self, figure: Figure, result: Result) -> None:
        """One panel for each law: the path with the minor loop over the large loop in grey."""
        labels = list(result.runs)
        panels = figure.subplots(result.rows, min(self.across, len(labels)), sharex=True, sharey=True, squeeze=False)
        unit, every = result.preset.unit_length, looks(labels)
        grey = {"color": "#C4C4C4", "linewidth": 2.6, "label": "without the minor loop"}
        for letter, axes, label in zip(ascii_lowercase, panels.flat, labels, strict=False):
            for case, look in (("large", grey), ("minor", {**every[label], "label": None})):
                run = result[label, case]
                axes.plot(1e6 * position(run), friction(run), **{**look, "linestyle": "-"})
            head(axes, letter, title(label))
        for axes in panels.flat[len(labels) :]:
            axes.set_axis_off()
        for axes in panels[-1]:
            axes.set_xlabel(f"displacement, {small(unit, 1e6)}")
        for axes in panels[:, 0]:
            axes.set_ylabel(f"friction, {result.preset.unit_force}")
        legend_below(panels[0][0])
