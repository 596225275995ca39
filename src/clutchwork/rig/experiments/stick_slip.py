"""Stick-slip of a mass on a belt."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.driveline.driveline import Driveline
from clutchwork.elements.bearing_friction import BearingFriction
from clutchwork.elements.prescribed_speed import PrescribedSpeed
from clutchwork.elements.spring import Spring
from clutchwork.rig.bench import Bench
from clutchwork.rig.experiment import Experiment, Result, experiment
from clutchwork.rig.looks import head, legend_below, looks, small
from clutchwork.rig.presets import Preset
from clutchwork.rig.table import TableColumn
from clutchwork.rig.trial import NOT_REACHED, Runs, Trial

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@experiment
@dataclass(frozen=True)
class StickSlip(Experiment):
    """How a mass that a spring holds on a moving belt sticks and slips.

    The belt carries the mass along until the spring pulls it off; it slips back and sticks again. A law without a
    coefficient at rest above the kinetic one settles to steady sliding.
    """

    title = "stick-slip of a mass on a belt"
    usual = ("stribeck", "lugre", "elastoplastic", "mykhalevych", "regularised_stribeck", "tanh")
    height = 120.0

    belt: float = 0.2  # speed of the belt over the Stribeck speed
    stiffness: float = 0.01  # of the spring, over that of the contact
    periods: float = 5.0  # of the motion, roughly
    still: float = 0.05  # slip that counts as sticking, over the speed of the belt

    def run(self, bench: Bench) -> Runs:
        """One run of some periods."""
        return {"belt": bench.simulate(self.driveline(bench), self.t_end(bench.preset), points=8000)}

    def driveline(self, bench: Bench) -> Driveline:
        """Mass, spring to the wall, belt."""
        d, preset = Driveline(f"{bench.label}, on a belt"), bench.preset
        pace = self.belt * preset.speed
        mass, belt = bench.body(d, speed=pace), bench.body(d, "belt", speed=pace)
        d.add(PrescribedSpeed("motion", shaft=belt, speed=pace))
        d.add(Spring("spring", base=d.housing, follower=mass, stiffness=self.spring(preset)))
        d.add(BearingFriction("friction", shaft=mass, base=belt, friction=bench.law, torque=bench.load))
        return d

    def spring(self, preset: Preset) -> float:
        """Stiffness of the spring [N/m]."""
        return self.stiffness * preset.stiffness * preset.load

    def t_end(self, preset: Preset) -> float:
        """Time to load the spring for the first time, and for some periods after that [s]."""
        loading = preset.force / (self.spring(preset) * self.belt * preset.speed)
        drop = 2.0 * (1.0 - preset.kinetic / preset.static)
        return float(loading * (1.0 + self.periods * drop))

    def columns(self, preset: Preset) -> tuple[TableColumn, ...]:
        """What is measured."""
        units = {"period": "s", "largest": preset.unit_force, "smallest": preset.unit_force, "sticks": "1"}
        return tuple(TableColumn(name, unit) for name, unit in units.items())

    def measure(self, trial: Trial) -> Sequence[float]:
        """Period, force of the spring at its ends, and the share of time in which the mass sticks; second half."""
        run = trial["belt"]
        late = run.time >= 0.5 * run.time[-1]
        time, pull = run.time[late], -run["spring.torque"][late]
        slow = np.abs(run["friction.slip"][late]) < self.still * self.belt * trial.preset.speed
        sticks = float(np.sum(np.diff(time) * slow[1:]) / (time[-1] - time[0]))
        return _period(time, pull, 0.01 * trial.preset.force), float(np.max(pull)), float(np.min(pull)), sticks

    def draw(self, figure: Figure, result: Result) -> None:
        """Force of the spring over time, and the last cycles in the plane of deflection and speed."""
        grid = figure.add_gridspec(2, 2, height_ratios=(1, 1.1))
        force, plane = figure.add_subplot(grid[0, :]), figure.add_subplot(grid[1, 0])
        zoom, preset = figure.add_subplot(grid[1, 1]), result.preset
        for label, look in looks(result.runs).items():
            run = result[label]
            thin, late = {**look, "linewidth": 0.9}, run.time >= 0.5 * run.time[-1]
            pull = -np.asarray(run["spring.torque"], dtype=float)
            force.plot(run.time, pull, **thin)
            plane.plot(pull[late], 1e3 * run["body.speed"][late], **thin)
            zoom.plot(run.time[late], 1e3 * run["friction.slip"][late], **thin)
        speed, unit = small(preset.unit_speed, 1e3), preset.unit_force
        head(force, "a", "force of the spring")
        force.set_xlabel("time, s")
        force.set_ylabel(f"force, {unit}")
        head(plane, "b", "second half: speed of the mass over force")
        plane.axhline(1e3 * self.belt * preset.speed, color="#404040", linewidth=0.6, linestyle=(0, (3, 2)))
        plane.set_xlabel(f"force of the spring, {unit}")
        plane.set_ylabel(f"speed, {speed}")
        head(zoom, "c", "second half: slip on the belt")
        zoom.set_xlabel("time, s")
        zoom.set_ylabel(f"slip, {speed}")
        legend_below(force)


def _period(time: np.ndarray, pull: np.ndarray, least: float) -> float:
    """Mean time between upward passages of the middle; NaN where nothing swings [s]."""
    middle = 0.5 * (np.max(pull) + np.min(pull))
    if np.max(pull) - np.min(pull) < least:
        return NOT_REACHED
    passages = time[1:][(pull[:-1] < middle) & (pull[1:] >= middle)]
    return float(np.mean(np.diff(passages))) if len(passages) > 1 else NOT_REACHED
