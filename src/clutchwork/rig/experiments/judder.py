"""Judder of a slipping clutch, and the damping that stops it."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.driveline.driveline import Driveline
from clutchwork.elements.bearing_friction import BearingFriction
from clutchwork.elements.prescribed_speed import PrescribedSpeed
from clutchwork.elements.spring_damper import SpringDamper
from clutchwork.rig.bench import Bench, speed
from clutchwork.rig.experiment import Experiment, Result, experiment
from clutchwork.rig.looks import GREY, GUIDE, head, legend_below, looks, nested, title
from clutchwork.rig.presets import Preset
from clutchwork.rig.table import Table, TableColumn
from clutchwork.rig.trial import NOT_REACHED, Runs, Trial

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from clutchwork.run.trajectory import Trajectory


@experiment
@dataclass(frozen=True)
class Judder(Experiment):
    """How much damping a driveline needs so that a falling coefficient does not make its clutch judder.

    The engine turns faster than a driveline that hangs on the vehicle by a damped spring; the clutch between them
    slips. Small vibrations grow by (|slope| - damping)/(2 inertia) per second, with the slope of the friction torque
    over slip: they grow while the damping is less than the slope. The damping is given over that limit, which is
    computed from the Stribeck curve of the preset.

    Source: R. A. Ibrahim, Friction-induced vibration, chatter, squeal, and chaos, part II, Applied Mechanics Reviews
    47, 1994, 227-253.
    """

    title = "clutch judder and its limit"
    usual = ("stribeck", "lugre", "elastoplastic", "gms", "mykhalevych", "coulomb")
    preset = "clutch"
    height = 130.0

    slip: float = 1.5  # mean slip over the Stribeck speed
    frequency: float = 15.0  # Hz of the driveline on its spring
    least: float = 0.5  # smallest damping over the limit
    most: float = 1.5  # largest damping over the limit
    points: int = 6
    periods: float = 12.0  # in which the growth is measured
    grown: float = 30.0  # periods of the run with the least damping
    pace: float = 10.0  # speed of the vehicle over the slip, so that nothing turns back

    def run(self, bench: Bench) -> Runs:
        """One run for each damping; the first is the longest."""
        t_end = self.periods / self.frequency
        runs = {f"{share:.3g}": self._slipping(bench, share, t_end) for share in self.shares}
        return {"judder": self._slipping(bench, self.least, self.grown / self.frequency), **runs}

    @property
    def shares(self) -> list[float]:
        """Dampings over the limit."""
        return [float(share) for share in np.linspace(self.least, self.most, self.points)]

    def limit(self, preset: Preset) -> float:
        """Damping at the limit of stability: the slope of friction over slip [N s/m]."""
        v, h = self.slip * preset.speed, 1e-4 * preset.speed
        return (preset.curve(v - h) - preset.curve(v + h)) / (2.0 * h)

    def growth(self, preset: Preset, share: float) -> float:
        """Growth of small vibrations for a damping over the limit [1/s]: (limit - damping)/(2 inertia)."""
        return 0.5 * (1.0 - share) * self.limit(preset) / preset.mass

    def driveline(self, bench: Bench, share: float) -> Driveline:
        """Engine, clutch, driveline, damped spring, vehicle; the spring carries the friction at the start."""
        d, preset = Driveline(f"{bench.label}, judder"), bench.preset
        slip, stiffness = self.slip * preset.speed, preset.mass * (2 * pi * self.frequency) ** 2
        road = self.pace * slip
        engine = bench.body(d, "engine", speed=road + slip)
        body = bench.body(d, speed=road - 0.002 * slip)
        vehicle = bench.body(d, "vehicle", speed=road)
        d.add(PrescribedSpeed("combustion", shaft=engine, speed=road + slip))
        d.add(PrescribedSpeed("road", shaft=vehicle, speed=road))
        d.add(BearingFriction("friction", shaft=body, base=engine, friction=bench.law, torque=bench.load))
        wound = preset.curve(slip) / stiffness
        d.add(
            SpringDamper(
                "halfshaft",
                base=vehicle,
                follower=body,
                stiffness=stiffness,
                damping=share * self.limit(preset),
                initial_twist=wound,
            )
        )
        return d

    def _slipping(self, bench: Bench, share: float, t_end: float) -> Trajectory:
        return bench.simulate(self.driveline(bench, share), t_end, points=max(1000, int(60 * t_end * self.frequency)))

    def table(self, preset: Preset, trials: Mapping[str, Trial]) -> Table:
        """Growth over damping: from theory, then measured with every law."""
        damping = "N m s/rad" if preset.unit_length == "rad" else "N s/m"
        heads = [TableColumn("damping", damping), TableColumn("over limit"), TableColumn("theory", "1/s")]
        lines = []
        for share in self.shares:
            measured = [self.measured(trial[f"{share:.3g}"], preset) for trial in trials.values()]
            lines.append((share * self.limit(preset), share, self.growth(preset, share), *measured))
        return Table((*heads, *(TableColumn(label, "1/s") for label in trials)), tuple(lines))

    def measured(self, run: Trajectory, preset: Preset) -> float:
        """Growth of the vibration while it is small [1/s]; NaN where there is none to measure."""
        omega, slip = 2 * pi * self.frequency, self.slip * preset.speed
        swing = np.hypot(speed(run) - self.pace * slip, run["body.acceleration"] / omega)
        begin = 0.5 / self.frequency
        large = np.flatnonzero((run.time > begin) & (swing > 0.15 * slip))
        end = run.time[large[0]] if len(large) else run.time[-1]
        part = (run.time >= begin) & (run.time <= end) & (swing > 1e-7 * slip)
        if np.sum(part) < 20 or end - begin < 0.5 / self.frequency:
            return NOT_REACHED
        return float(np.polyfit(run.time[part], np.log(swing[part]), 1)[0])

    def draw(self, figure: Figure, result: Result) -> None:
        """Growth over damping with the limit, and the slip below it."""
        grid = figure.add_gridspec(2, 2, height_ratios=(1.15, 1))
        growth = figure.add_subplot(grid[0, :])
        course, late = figure.add_subplot(grid[1, 0]), figure.add_subplot(grid[1, 1])
        shares = [float(cell) for cell in result.table["over limit"]]
        theory = [float(cell) for cell in result.table["theory"]]
        growth.axvspan(shares[0] - 0.02, 1.0, color="#F4E7E0", zorder=0, linewidth=0)
        growth.plot(shares, theory, label="theory", **GREY)
        growth.axhline(0.0, color="#404040", linewidth=0.6)
        growth.axvline(1.0, **GUIDE)
        for label, look in nested(result.runs).items():
            growth.plot(shares, [float(c) for c in result.table[label]], **look)
            run = result[label]
            part = run.time >= run.time[-1] - 3.0 / self.frequency
            late.plot(run.time[part], -run["friction.slip"][part], **{**look, "linewidth": 0.9})
        self._envelopes(course, result)
        self._words(growth, self.limit(result.preset), result.table.columns[0].unit)
        late.locator_params(axis="x", nbins=5)
        head(late, "c", f"judder at {self.least:g} of the limit, last three periods")
        for axes in (course, late):
            axes.set_xlabel("time, s")
            axes.set_ylabel(f"slip, {result.preset.unit_speed}")
        legend_below(growth)

    def _envelopes(self, course: Axes, result: Result) -> None:
        """Slip of the first law, below and above the limit."""
        label = next(iter(result.trials))
        look = looks(result.runs)[label]
        for share, above in (("judder", {"linewidth": 0.6}), (f"{self.most:.3g}", {"color": "#9A9A9A", "zorder": 3})):
            run = result[label, share]
            course.plot(run.time, -run["friction.slip"], **{**look, **above})
        course.set_xlim(0.0, result[label, "judder"].time[-1])
        head(course, "b", f"slip of {title(label)} at {self.least:g} and, grey, {self.most:g} of the limit")

    def _words(self, growth: Axes, limit: float, unit: str) -> None:
        head(growth, "a", "growth of small vibrations")
        growth.set_xlim(self.least - 0.02, self.most + 0.02)
        growth.set_xlabel(f"damping of the driveline / {limit:.3g} {unit}, the slope of friction over slip")
        growth.set_ylabel("growth rate, 1/s")
        for x, side, words in ((1.0, "right", "judders"), (1.0, "left", "dies out")):
            growth.annotate(
                words, (x, 0.96), (-6 if side == "right" else 6, 0), xycoords=("data", "axes fraction"),
                textcoords="offset points", ha=side, va="top",
            )  # fmt: skip
