"""Runs of the core that stand at an instant."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.declare.layout import DONE
from clutchwork.run.begin import begun
from clutchwork.run.control import controllers
from clutchwork.run.settings import without_end
from clutchwork.run.simulation import simulate, told
from clutchwork.run.trajectory import SimulationError

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options
    from clutchwork.results.state import State
    from clutchwork.run.trajectory import Trajectory

# a run that is only asked for its start [s]
SHORT = 1e-6


def options_of(system: System) -> Options:
    """What a run of a model is done with by its settings; all that a linear system may show is integrated."""
    return without_end(system.settings, {}).changed({"dt": None, "output": "steps", "angles": True, "work": True})


def started(system: System, start: State | None = None) -> Any:
    """A run at the start, or at a saved state, controllers asked."""
    options = options_of(system)
    if start is not None:
        start.fits(system)
        options = options.changed({"t_start": start.time})
    if controllers(system.inputs, start.held if start is not None else {}):
        begin = options.t_start
        return reached(simulate(system, begin + SHORT, start=start, options=options), begin)
    return begun(system, options, start)


def reached(trajectory: Trajectory, at: float) -> Any:
    """A run at a time [s]: repeated up to there, bit for bit, and what controllers decided is replayed."""
    state = trajectory.state(at=at)
    run = begun(trajectory.system, trajectory.options.changed({"angles": True, "work": True}), state)
    asked = controllers(trajectory.system.inputs, state.held)
    # a state is what a run is before controllers are asked, and what they said follows
    if asked:
        after = trajectory.at([at, at])
        for one in asked:
            run.set_input(one.index, float(after[one.name][-1]))
    return run


def refuse_stopped(system: System, run: Any, status: int) -> None:
    """SimulationError where a run did not get there."""
    if status != DONE:
        index, time, value, column = run.detail()
        raise SimulationError(told(system, status, index, time, value, max(column, 0)))


def step_over(run: Any, to: float) -> None:
    """Let a run go on by very little, over an event that it has stopped at."""
    run.advance(to, np.empty(0), np.empty((0, run.row_size)), 0, 0)
