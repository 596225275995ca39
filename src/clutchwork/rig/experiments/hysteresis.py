"""Hysteresis loops over displacement and over speed."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.rig.bench import Bench, friction, position, speed
from clutchwork.rig.experiment import Experiment, Result, experiment
from clutchwork.rig.looks import head, legend_below, looks, small
from clutchwork.rig.presets import Preset
from clutchwork.rig.table import TableColumn
from clutchwork.rig.trial import Runs, Trial
from clutchwork.signals.sine import Sine

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CASES = ("elastic", "sliding")


@experiment
@dataclass(frozen=True)
class Hysteresis(Experiment):
    """Loops of friction over displacement and over speed, before sliding and with it.

    A body is moved back and forth in a sine: once so little that the contact only deforms, once so far that it slides.
    The area of a loop over displacement is the energy that one cycle turns into heat.
    """

    title = "hysteresis under imposed motion"
    usual = ("mykhalevych", "elastoplastic", "gms", "lugre", "stribeck")
    height = 130.0

    elastic: float = 0.5  # amplitude over the elastic deflection, static coefficient / stiffness
    sliding: float = 20.0  # the same with sliding
    frequency: float = 1.0  # Hz
    cycles: int = 5
    samples: int = 800  # per cycle

    def run(self, bench: Bench) -> Runs:
        """One run for each amplitude."""
        runs = {}
        for case, share in zip(CASES, (self.elastic, self.sliding), strict=True):
            peak = 2 * pi * self.frequency * share * bench.preset.length
            d = bench.moved(Sine(amplitude=peak, frequency=self.frequency, phase=pi / 2), start=peak)
            t_end = self.cycles / self.frequency
            times = np.linspace(0.0, t_end, self.cycles * self.samples + 1)
            runs[case] = bench.simulate(d, t_end, times=times)
        return runs

    def columns(self, preset: Preset) -> tuple[TableColumn, ...]:
        """What is measured."""
        parts = (("peak", preset.unit_force), ("heat per cycle", "J"), ("cycle to cycle", "1"))
        return tuple(TableColumn(f"{case} {name}", unit) for case in CASES for name, unit in parts)

    def measure(self, trial: Trial) -> Sequence[float]:
        """Largest force and heat of the last cycle, and by which share the last two cycles differ."""
        numbers: list[float] = []
        for case in CASES:
            run, n = trial[case], self.samples
            force, heat = friction(run), run["friction.heat"]
            peak = float(np.max(np.abs(force[-n:])))
            differ = float(np.max(np.abs(force[-n:] - force[-2 * n : -n]))) / peak if peak else 0.0
            numbers += [peak, float(heat[-1] - heat[-1 - n]), differ]
        return numbers

    def draw(self, figure: Figure, result: Result) -> None:
        """Two rows for the two amplitudes, two columns for displacement and speed."""
        panels = figure.subplots(2, 2, sharey="row")
        unit, scale = result.preset.unit_length, {"elastic": 1e6, "sliding": 1e3}
        for row, case in enumerate(CASES):
            over_x, over_v = panels[row]
            for label, look in looks(result.runs).items():
                run = result[label, case]
                # where it slides it has settled after the first reversals
                part = slice(0 if case == "elastic" else -2 * self.samples - 1, None)
                x, v, force = position(run)[part], speed(run)[part], friction(run)[part]
                thin = {**look, "linewidth": 0.9}
                over_x.plot(scale[case] * x, force, **thin)
                over_v.plot(scale[case] * v, force, **thin)
            head(over_x, "ac"[row], ("elastic zone", "with sliding")[row] + ", over displacement")
            head(over_v, "bd"[row], "over speed")
            over_x.set_xlabel(f"displacement, {small(unit, scale[case])}")
            over_v.set_xlabel(f"speed, {small(unit, scale[case])}/s")
            over_x.set_ylabel(f"friction, {result.preset.unit_force}")
        legend_below(panels[0][0])
