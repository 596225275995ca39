"""The drift test."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from clutchwork.base import dataclass
from clutchwork.rig.bench import Bench, position
from clutchwork.rig.experiment import Experiment, Result, experiment
from clutchwork.rig.looks import head, legend_below, looks, small
from clutchwork.rig.presets import Preset
from clutchwork.rig.table import TableColumn
from clutchwork.rig.trial import Runs, Trial
from clutchwork.signals.sine import Sine
from clutchwork.signals.table import Table as Course

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from clutchwork.declare.node import Signal


class Swinging(NamedTuple):
    """A load that swings."""

    mean: float  # share of the static force
    swing: float  # share of the static force, amplitude
    frequency: float  # Hz
    end: float  # s


@experiment
@dataclass(frozen=True)
class Drift(Experiment):
    """Whether a body creeps under a load that oscillates below break-away.

    A body is pushed over break-away once, then carries a biased sine whose peak stays below the kinetic friction,
    then nothing. Loads are shares of the static force. Use it to see which laws hold a load and which let it creep.

    Source: P. Dupont, V. Hayward, B. Armstrong, F. Altpeter 2002, doi:10.1109/TAC.2002.1000274.
    """

    title = "drift test"
    usual = (
        "mykhalevych", "elastoplastic", "gms", "leuven", "stribeck",
        "lugre", "dahl", "regularised_stribeck", "tanh",
    )  # fmt: skip
    height = 150.0

    push: float = 1.3  # share of the static force, peak of the first phase
    mean: float | None = None  # share; None: of the preset
    swing: float | None = None  # share; None: of the preset
    frequency: float | None = None  # Hz; None: of the preset
    begin: float = 5.0  # s, the sine begins
    end: float | None = None  # s, the load ends; None: of the preset
    rest: float = 2.0  # s of rest after that

    def run(self, bench: Bench) -> Runs:
        """One run with samples every 5 ms."""
        d = bench.pushed(*self.forces(bench.preset))
        return {"drift": bench.simulate(d, self.sine(bench.preset).end + self.rest, dt=0.005)}

    def sine(self, preset: Preset) -> Swinging:
        """The swinging load: what is given, the rest from the preset."""
        given = (self.mean, self.swing, self.frequency, self.end)
        own = (preset.mean, preset.swing, preset.frequency, preset.end)
        return Swinging(*(b if a is None else a for a, b in zip(given, own, strict=True)))

    def forces(self, preset: Preset) -> tuple[Signal, ...]:
        """The course of the load [N]: ramps and holding, the sine, and its end."""
        unit, (mean, swing, frequency, end) = preset.force, self.sine(preset)
        corners = ((0, 0), (1, 0), (2, self.push), (3, mean), (end, mean), (end, 0))
        held = Course([(float(t), unit * share) for t, share in corners])
        swinging = Sine(amplitude=unit * swing, frequency=frequency, start=self.begin)
        turns = 2 * pi * ((frequency * (end - self.begin)) % 1.0)
        return held, swinging, Sine(amplitude=-unit * swing, frequency=frequency, start=end, phase=turns)

    def columns(self, preset: Preset) -> tuple[TableColumn, ...]:
        """What is measured."""
        unit = preset.unit_length
        names = ("after the push", "creep", "late creep", "after the load")
        return tuple(TableColumn(name, unit) for name in names)

    def measure(self, trial: Trial) -> Sequence[float]:
        """Displacement by the push, over whole periods without the first, over the last of them, and after the load."""
        _, _, frequency, end = self.sine(trial.preset)
        periods = floor((end - self.begin) * frequency + 1e-9)
        first, late, last = (self.begin + n / frequency for n in (1, min(11, periods), periods))
        instants = (self.begin, first, late, last, end, end + self.rest)
        x = np.interp(instants, trial["drift"].time, position(trial["drift"]))
        return float(x[0]), float(x[3] - x[1]), float(x[3] - x[2]), float(x[5] - x[4])

    def draw(self, figure: Figure, result: Result) -> None:
        """Load, displacement, creep in two scales."""
        force, whole, creep, fine = figure.subplots(4, 1, sharex=True, height_ratios=(0.6, 1, 1, 1))
        self._load(force, result)
        head(whole, "b", "displacement")
        head(creep, "c", "creep since the sine began")
        head(fine, "d", "the same, enlarged: laws that do not creep")
        unit, length = result.preset.unit_length, result.preset.length
        for label, look in looks(result.runs).items():
            run = result[label]
            x, since = position(run), run.time >= self.begin
            whole.plot(run.time, x, **look)
            if not np.any(since):
                continue
            grown = x[since] - x[since][0]
            creep.plot(run.time[since], 1e3 * grown, **look)
            if np.max(np.abs(grown)) < length:
                fine.plot(run.time[since], 1e6 * grown, **look)
        whole.set_ylabel(f"displacement, {unit}")
        creep.set_ylabel(f"creep, {small(unit, 1e3)}")
        fine.set_ylabel(f"creep, {small(unit, 1e6)}")
        fine.set_xlabel("time, s")
        fine.set_xlim(0.0, self.sine(result.preset).end + self.rest)
        legend_below(whole)
        figure.align_ylabels()

    def _load(self, axes: Axes, result: Result) -> None:
        mean, swing, frequency, end = self.sine(result.preset)
        time = np.linspace(0.0, end + self.rest, 4001)
        load = np.interp(time, (0, 1, 2, 3, end), (0, 0, self.push, mean, mean))
        load += np.where(time > self.begin, swing * np.sin(2 * pi * frequency * (time - self.begin)), 0.0)
        axes.plot(time, result.preset.force * np.where(time <= end, load, 0.0), color="#404040", linewidth=0.8)
        axes.set_ylabel(f"load, {result.preset.unit_force}")
        head(axes, "a", "load")
