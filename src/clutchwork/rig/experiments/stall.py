"""Launch, locked drive and engine braking: where the naive law stalls."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.declare.node import Domain
from clutchwork.driveline.driveline import Driveline
from clutchwork.elements.clutch import Clutch
from clutchwork.elements.resisting_torque import ResistingTorque
from clutchwork.elements.spring_damper import SpringDamper
from clutchwork.elements.torque import Torque
from clutchwork.rig.bench import Bench
from clutchwork.rig.experiment import Experiment, Result, experiment
from clutchwork.rig.looks import looks, title
from clutchwork.rig.presets import Preset
from clutchwork.rig.table import TableColumn
from clutchwork.rig.trial import NOT_REACHED, Runs, Trial
from clutchwork.signals.table import Table as Course

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from clutchwork.run.trajectory import Trajectory


@experiment
@dataclass(frozen=True)
class Stall(Experiment):
    """What a solver does when a clutch locks.

    Engine, clutch, gearbox input and a vehicle behind an elastic halfshaft, reduced to the speed of the gearbox
    input: launch from rest, locked drive, then engine braking, in which the torque passes through zero while locked.
    A law that is nothing but a sign has no torque for a locked clutch: the solver jumps between both signs, and the
    run ends with a diagnosis. The curves join the solver's own steps.
    """

    title = "launch, locked drive, engine braking"
    own_preset = True
    usual = ("naive_sign", "mykhalevych", "stribeck")
    preset = "clutch"
    height = 50.0
    across = 1
    whole: ClassVar[bool] = False

    engine: float = 0.2  # kg m2
    gearbox: float = 0.05  # kg m2
    vehicle: float = 2.0  # kg m2
    halfshaft: float = 400.0  # N m/rad
    damping: float = 1.0  # N m s/rad
    speed: float = 150.0  # rad/s of the engine at the start
    drive: float = 120.0  # N m of the engine
    brake: float = -40.0  # N m of the engine from 2 s on
    road: float = 10.0  # N m against the vehicle
    t_end: float = 3.0  # s

    def run(self, bench: Bench) -> Runs:
        """One run with the bare steps of the solver as output."""
        return {"launch": bench.simulate(self.driveline(bench), self.t_end, output="steps", rtol=1e-6, atol=1e-8)}

    def driveline(self, bench: Bench) -> Driveline:
        """The driveline with the clutch of a bench; ValueError for a preset that is not one of shafts."""
        if bench.preset.domain is not Domain.ROTATION:
            raise ValueError(f'a clutch joins shafts, preset {bench.preset.name!r} is for masses: use preset "clutch"')
        d = Driveline("launch")
        engine = d.shaft("engine", inertia=self.engine, speed=self.speed)
        gearbox = d.shaft("gearbox", inertia=self.gearbox)
        vehicle = d.shaft("vehicle", inertia=self.vehicle)
        combustion = Course([(0.0, self.drive), (2.0, self.drive), (2.3, self.brake)])
        d.add(Torque("combustion", shaft=engine, torque=combustion))
        d.add(
            Clutch(
                "clutch",
                base=engine,
                follower=gearbox,
                friction=bench.law,
                gain=bench.load,
                normal_force=Course([(0.0, 0.0), (0.8, 1.0)]),
            )
        )
        stiffness, damping = self.halfshaft, self.damping
        d.add(SpringDamper("halfshaft", base=gearbox, follower=vehicle, stiffness=stiffness, damping=damping))
        d.add(ResistingTorque("road", shaft=vehicle, torque=self.road, speed=0.5))
        return d

    def columns(self, preset: Preset) -> tuple[TableColumn, ...]:
        """What is measured."""
        units = {"steps": "1", "reached": "s", "slip gone at": "s", "heat": "J", "last torque": preset.unit_force}
        return tuple(TableColumn(name, unit) for name, unit in units.items())

    def measure(self, trial: Trial) -> Sequence[float]:
        """Steps, time that was reached, when the slip fell below 0.1 % of its start, heat and torque at the end."""
        run = trial["launch"]
        gone = np.flatnonzero(np.abs(run["clutch.slip"]) < 1e-3 * self.speed)
        lost = float(run.time[gone[0]]) if len(gone) else NOT_REACHED
        last = run["clutch.torque"][-1]
        return float(run.statistics["steps"]), float(run.time[-1]), lost, float(run["clutch.heat"][-1]), float(last)

    def draw(self, figure: Figure, result: Result) -> None:
        """Torque over the number of the step and over time, one row for each law."""
        labels, every = list(result.runs), looks(result.runs)
        panels = figure.subplots(len(labels), 2, sharey=True, squeeze=False, width_ratios=(1, 1))
        for row, label in enumerate(labels):
            run = result[label]
            torque, look = run["clutch.torque"], {**every[label], "linewidth": 0.8, "linestyle": "-"}
            for axes, x in zip(panels[row], (np.arange(len(run)), run.time), strict=True):
                axes.plot(x, torque, **look, marker=".", markersize=2.0)
                axes.axhline(0.0, color="#B0B0B0", linewidth=0.5, zorder=1)
                axes.set_title(f"{title(label)}: {_end(run)}" if axes is panels[row][0] else "", loc="left")
            panels[row][0].set_ylabel("torque, N m")
            panels[row][0].set_xlim(0, _shown(torque))
            panels[row][1].set_xlim(0.0, self.t_end)
        panels[-1][0].set_xlabel("number of the step")
        panels[-1][1].set_xlabel("time, s")


def _shown(torque: NDArray[np.float64]) -> int:
    """Number of steps to show: all, or some more after the torque began to jump between its signs."""
    jumps = np.flatnonzero((torque[1:] * torque[:-1] < 0.0) & (np.abs(np.diff(torque)) > np.max(np.abs(torque))))
    return min(len(torque), int(jumps[0]) + 80) if len(jumps) else len(torque)


def _end(run: Trajectory) -> str:
    end = "complete" if run.finished else f"{run.status} at {run.time[-1]:.4f} s"
    shown = _shown(run["clutch.torque"])
    return end if shown >= len(run) else f"{end}, first {shown} of {run.statistics['steps']} steps"
