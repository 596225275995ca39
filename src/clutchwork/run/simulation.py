"""Run a System and collect what it does."""

from __future__ import annotations

import os
import time
import warnings
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol, Unpack

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import wiring
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import UseError, caller
from clutchwork.base.shown import shown
from clutchwork.declare.calls import explained
from clutchwork.declare.core import core
from clutchwork.declare.options import Options, instants
from clutchwork.declare.status import DONE, INTERRUPTED, NAMES, NOT_FINITE
from clutchwork.results.channels import channels
from clutchwork.results.events import from_rows
from clutchwork.results.trajectory import SimulationError, Trajectory
from clutchwork.run.control import Control, controllers
from clutchwork.run.effort import refuse_endless
from clutchwork.run.failure import Interrupted, StoppedEarly, explain, report_faults
from clutchwork.run.grid import output_grid
from clutchwork.run.jumps import jump_times
from clutchwork.run.record import Progress, Recording, record
from clutchwork.run.settings import merged

if TYPE_CHECKING:
    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields

Array = NDArray[np.float64]


class Assembles(Protocol):
    """What can be assembled to a System: a Driveline."""

    def assemble(self) -> System:
        """The System of it."""


@dataclass(frozen=True)
class Job:
    """One run that is wanted."""

    system: System
    t_end: float
    options: Options
    control: Control

    def again(self, times: Any) -> Trajectory:
        """Repeat it on other instants [s]; what controllers decided is replayed, not asked for again."""
        wanted = np.sort(np.atleast_1d(np.asarray(instants(times), dtype=float)))
        return _trajectory(replace(self, options=self.options.changed({"times": wanted, "dt": None})), None)


@explained("simulate")
def simulate(
    model: Assembles | System,
    t_end: Number | None = None,
    *,
    options: Options | None = None,
    progress: Progress | None = None,
    **changes: Unpack[OptionFields],
) -> Trajectory:
    """Compute the motion of a Driveline or a System from 0 to t_end.

    Parameters: t_end [s], or with a unit, "500 ms"; options, an `Options`, or its fields by name (rtol=, dt=, method=
    ...); progress, a function of (time reached [s], t_end [s]) that is called now and then.

    What is left out is that of the settings of the model, `Driveline.simulation`, which a model file holds in its
    [simulation] table; `options` replaces all of them but t_end.

    A fault that its element reports as a warning is a `FaultWarning`. A run that cannot go on warns with `StoppedEarly`
    and returns the trajectory so far, with `status` and `message`.
    A controller that raises ends in `SimulationError`, which holds the trajectory so far too, and so does
    `Interrupted`, the KeyboardInterrupt that Ctrl-C raises.
    """
    if options is not None and not isinstance(options, Options):
        raise UseError("simulate", [f"options is {shown(options)}: it must be cw.Options(...)"])
    if not isinstance(model, System) and not hasattr(model, "assemble"):
        raise UseError("simulate", [_no_model(model)])
    system = model if isinstance(model, System) else model.assemble()
    given = {**changes} if t_end is None else {**changes, "t_end": t_end}
    end, chosen = merged(system.settings, given, options)
    refuse_endless(system.inputs, end, chosen.max_steps)
    control = Control(controllers(system.inputs), partial(channels, system))
    run = _trajectory(Job(system, end, chosen, control), progress)
    report_faults(run)
    return run


def _no_model(given: object) -> str:
    remedy = "give a Driveline or a System"
    if isinstance(given, str | os.PathLike):
        remedy = f"load a file with cw.Driveline.load({os.fspath(given)!r})"
    return f"{shown(given)} is not a model; {remedy}"


def _trajectory(job: Job, progress: Progress | None) -> Trajectory:
    """Run, and report how it ended."""
    started = time.perf_counter()
    recording, failure = _collect(job, progress)
    made = _named(job, recording, time.perf_counter() - started)
    if failure is not None:
        raise SimulationError(str(failure), made) from failure.__cause__
    if isinstance(recording.raised, KeyboardInterrupt):
        raise Interrupted(made.message, made) from None
    if recording.raised is not None:
        raise recording.raised
    if not made.finished:
        warnings.warn(StoppedEarly(made.message, made), stacklevel=caller())
    return made


def _collect(job: Job, progress: Progress | None) -> tuple[Recording, SimulationError | None]:
    """Record a run; smooth output repeats it on a grid that is known to hold every step and event."""
    data, grid = job.system.to_bytes(), output_grid(job.options, job.t_end)
    first, failure = _once(job, data, grid, progress)
    if grid is not None or job.options.output != "smooth" or failure is not None or first.status == INTERRUPTED:
        return first, failure
    spacing = job.t_end / job.options.points
    finer = refined(first.times, spacing, jump_times(job.system, job.t_end))
    if finer.size == first.times.size:
        return first, None
    second, failure = _once(job, data, finer, None)
    second.core_seconds = first.core_seconds
    if second.status == INTERRUPTED:
        # the bare steps reach further
        first.status, first.raised = INTERRUPTED, second.raised
        return first, None
    return second, failure


def _once(
    job: Job, data: bytes, grid: Array | None, progress: Progress | None
) -> tuple[Recording, SimulationError | None]:
    run = new_run(data)
    for name, value in job.options.core_options().items():
        run.set_option(name, value)
    recording = Recording(run, run.row_size)
    try:
        record(recording, job.t_end, grid, job.control, progress)
    except SimulationError as error:
        return recording, error
    except KeyboardInterrupt as error:
        # between two calls of the core
        recording.status, recording.raised = INTERRUPTED, error
    return recording, None


def new_run(data: bytes) -> Any:
    """A run of the compiled core over the bytes of a System."""
    return core().Run(data)


def refined(steps: Array, spacing: float, jumps: Array) -> Array:
    """The solver's steps with more instants where they lie further apart than the spacing.

    An instant that appears twice stays so; where a signal jumps it is duplicated.
    """
    gaps = steps[1:] - steps[:-1]
    parts = np.maximum(1, np.ceil(gaps / spacing - 1e-9)).astype(int)
    left, width = np.repeat(steps[:-1], parts), np.repeat(gaps / parts, parts)
    number = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    grid = np.append(left + number * width, steps[-1:])
    reached = jumps[jumps < grid[-1]] if grid.size else jumps[:0]
    present = np.searchsorted(grid, reached, "right") - np.searchsorted(grid, reached, "left")
    return np.sort(np.concatenate([grid, np.repeat(reached, np.maximum(0, 2 - present))]))


def _message(system: System, status: int, run: Any) -> str:
    """Why a run stopped. What is not finite is an element, or a number of a row; else the largest one is named."""
    index, at, value, column = run.detail()
    if status == NOT_FINITE and not names_part(system, index) and column < 0:
        row = np.asarray(run.row())
        column = int(np.argmax(np.abs(row)))
        value = float(row[column])
    return told(system, status, index, at, value, column)


def names_part(system: System, index: int) -> bool:
    """Whether a number is that of an element or a contact."""
    return 0 <= index < len(system.elements) + len(system.contacts)


def told(system: System, status: int, index: int, at: float, value: float, column: int) -> str:
    """Why a run stopped at a time: an element or contact by its number, and its value, or a number of the row."""
    parts = [*system.elements, *system.contacts]
    if NAMES[status] == "zeno" and index < 0:
        return explain(status, None, at, value, system.inputs[int(value)].name)
    if status != NOT_FINITE or names_part(system, index):
        return explain(status, parts[index] if names_part(system, index) else None, at, value)
    from clutchwork.results.rows import numbers

    name, _ = numbers(wiring(system))[column]
    return explain(status, None, at, value, name)


def _named(job: Job, recording: Recording, seconds: float) -> Trajectory:
    """The numbers of a run with the names of its system."""
    run, status, system = recording.run, recording.status, job.system
    message = ""
    if status != DONE:
        message = _message(system, status, run)
    return Trajectory(
        system=system,
        options=job.options,
        t_end=job.t_end,
        time=recording.times,
        rows=recording.rows,
        events=from_rows(recording.events, [contact.name for contact in system.contacts]),
        status=NAMES[status],
        message=message,
        repeat=job.again,
        statistics={**run.statistics(), "core_seconds": recording.core_seconds, "seconds": seconds},
    )
