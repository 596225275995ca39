"""Runs of the core that stand at an instant."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.declare.core import core
from clutchwork.declare.options import DEFAULTS
from clutchwork.declare.status import DONE
from clutchwork.results.channels import channels
from clutchwork.results.trajectory import SimulationError
from clutchwork.run.simulation import simulate, told

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.results.trajectory import Trajectory

# a run that is only asked for its start [s]
SHORT = 1e-6


def started(system: System) -> Any:
    """A run at the start, controllers asked."""
    if any(item.signal.sampling() is not None for item in system.inputs):
        return reached(simulate(system, SHORT, options=DEFAULTS), 0.0)
    run = core().Run(system.to_bytes())
    for name, value in DEFAULTS.core_options().items():
        run.set_option(name, value)
    return run


def reached(trajectory: Trajectory, at: float) -> Any:
    """A run at a time [s]: repeated up to there, bit for bit, and what controllers decided is replayed."""
    run = core().Run(trajectory.system.to_bytes())
    capture = getattr(trajectory, "state", None)
    if capture is not None:
        run.restore(capture(at).core)
        return run
    for name, value in trajectory.options.core_options().items():
        run.set_option(name, value)
    _repeat(run, trajectory, at)
    return run


def resumed(system: System, state: Any) -> Any:
    """A run at a saved state of it."""
    state.fits(system)
    run = core().Run(system.to_bytes())
    run.restore(state.core)
    return run


def _repeat(run: Any, trajectory: Trajectory, at: float) -> None:
    from clutchwork.run.control import Control, controllers
    from clutchwork.run.record import Recording, record
    from clutchwork.run.simulation import Job

    system, job = trajectory.system, getattr(trajectory.repeat, "__self__", None)
    if not isinstance(job, Job):
        # it says why it cannot be repeated, where that is so
        trajectory.at([at])
    own = Control(controllers(system.inputs), lambda: channels(system, True, True))
    recording = Recording(run, run.row_size)
    record(recording, at, np.array([at]), job.control if isinstance(job, Job) else own, None)
    if recording.raised is not None:
        raise recording.raised
    refuse_stopped(system, run, recording.status)


def refuse_stopped(system: System, run: Any, status: int) -> None:
    """SimulationError where a run did not get there."""
    if status != DONE:
        index, time, value, column = run.detail()
        raise SimulationError(told(system, status, index, time, value, max(column, 0)))


def step_over(run: Any, to: float) -> None:
    """Let a run go on by very little, over an event that it has stopped at."""
    run.advance(to, np.empty(0), np.empty((0, run.row_size)), 0, 0)
