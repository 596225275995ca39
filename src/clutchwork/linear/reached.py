"""Runs of the core that stand at an instant."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.declare.core import core
from clutchwork.declare.options import DEFAULTS
from clutchwork.declare.status import DONE
from clutchwork.results.trajectory import SimulationError
from clutchwork.run.control import controllers
from clutchwork.run.simulation import simulate, told

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.results.trajectory import Trajectory

# a run that is only asked for its start [s]
SHORT = 1e-6


def started(system: System, begin: float) -> Any:
    """A run at its start at a time [s], controllers asked."""
    options = DEFAULTS.changed({"t_start": begin})
    if any(item.signal.sampling() is not None for item in system.inputs):
        return reached(simulate(system, begin + SHORT, options=options), begin)
    run = core().Run(system.to_bytes())
    for name, value in options.core_options().items():
        run.set_option(name, value)
    return run


def reached(trajectory: Trajectory, at: float) -> Any:
    """A run at a time [s]: repeated up to there, bit for bit, and what controllers decided is replayed."""
    run = resumed(trajectory.system, trajectory.state(at=at))
    asked = controllers(trajectory.system.inputs)
    # a state is what a run is before controllers are asked, and what they said follows
    if asked:
        after = trajectory.at([at, at])
        for one in asked:
            run.set_input(one.index, float(after[one.name][-1]))
    return run


def resumed(system: System, state: Any) -> Any:
    """A run at a saved state of it."""
    state.fits(system)
    run = core().Run(system.to_bytes())
    run.restore(state.core)
    return run


def refuse_stopped(system: System, run: Any, status: int) -> None:
    """SimulationError where a run did not get there."""
    if status != DONE:
        index, time, value, column = run.detail()
        raise SimulationError(told(system, status, index, time, value, max(column, 0)))


def step_over(run: Any, to: float) -> None:
    """Let a run go on by very little, over an event that it has stopped at."""
    run.advance(to, np.empty(0), np.empty((0, run.row_size)), 0, 0)
