"""Run a System and collect what it does."""

from __future__ import annotations

import time
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.channels import Channels
from clutchwork.control import Control, controllers
from clutchwork.events import from_rows
from clutchwork.failure import DONE, NAMES, SimulationError, StoppedEarly, explain
from clutchwork.options import Options, end_time
from clutchwork.record import Progress, Recording, record
from clutchwork.system import System
from clutchwork.trajectory import Trajectory
from clutchwork.wiring import wiring

if TYPE_CHECKING:
    from clutchwork.driveline import Driveline

Array = NDArray[np.float64]


def simulate(
    model: Driveline | System,
    t_end: float,
    *,
    options: Options | None = None,
    progress: Progress | None = None,
    **changes: Any,
) -> Trajectory:
    """Compute the motion of a Driveline or a System from 0 to t_end.

    Parameters: t_end [s]; options, an `Options`, or its fields by name (rtol=, dt=, method= ...); progress, a
    function of (time reached [s], t_end [s]) that is called now and then.

    A run that cannot go on warns with `StoppedEarly` and returns the trajectory so far, with `status` and `message`.
    A controller that raises ends in `SimulationError`, which holds the trajectory so far too.
    """
    t_end = end_time(t_end)
    chosen = (options or Options()).changed(changes)
    system = model if isinstance(model, System) else model.assemble()
    control = Control(controllers(system.inputs), lambda: Channels(wiring(system)))
    return _run(system, t_end, chosen, control, progress)


def again(trajectory: Trajectory, times: Any) -> Trajectory:
    """Repeat a run on other instants [s]; what controllers decided is replayed, not asked for again."""
    instants = np.sort(np.atleast_1d(np.asarray(times, dtype=float)))
    options = trajectory.options.changed({"times": instants, "dt": None})
    return _run(trajectory.system, trajectory.t_end, options, trajectory.control, None)


def _run(system: System, t_end: float, options: Options, control: Control, progress: Progress | None) -> Trajectory:
    started = time.perf_counter()
    recording, failure = _collect(system, t_end, options, control, progress)
    made = _trajectory(system, t_end, options, control, recording, time.perf_counter() - started)
    if failure is not None:
        raise SimulationError(str(failure), made) from failure.__cause__
    if not made.finished:
        warnings.warn(StoppedEarly(made.message, made), stacklevel=3)
    return made


def _collect(
    system: System, t_end: float, options: Options, control: Control, progress: Progress | None
) -> tuple[Recording, SimulationError | None]:
    """Record a run; smooth output repeats it on a grid that is known to hold every step and event."""
    data = system.to_bytes()
    grid = options.grid(t_end)
    first, failure = _once(data, t_end, options, grid, control, progress)
    if grid is None and options.output == "smooth" and failure is None:
        finer = refined(first.times, t_end / options.points)
        if finer.size > first.times.size:
            second, failure = _once(data, t_end, options, finer, control, None)
            second.core_seconds = first.core_seconds
            return second, failure
    return first, failure


def _once(
    data: bytes, t_end: float, options: Options, grid: Array | None, control: Control, progress: Progress | None
) -> tuple[Recording, SimulationError | None]:
    run = new_run(data)
    for name, value in options.core_options().items():
        run.set_option(name, value)
    recording = Recording(run)
    try:
        record(recording, t_end, grid, control, progress)
    except SimulationError as error:
        return recording, error
    return recording, None


def new_run(data: bytes) -> Any:
    """A run of the compiled core over the bytes of a System."""
    from clutchwork import _core

    return _core.Run(data)


def refined(times: Array, spacing: float) -> Array:
    """Instants with more between them where they lie further apart than the spacing; doubled instants stay."""
    gaps = np.diff(times)
    parts = np.maximum(1, np.ceil(gaps / spacing - 1e-9)).astype(int)
    left, width = np.repeat(times[:-1], parts), np.repeat(gaps / parts, parts)
    number = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.append(left + number * width, times[-1:])


def _trajectory(
    system: System, t_end: float, options: Options, control: Control, recording: Recording, seconds: float
) -> Trajectory:
    run, status = recording.run, recording.status
    message = ""
    if status != DONE:
        index, at, value = run.detail()
        parts = [*system.elements, *system.contacts]
        message = explain(status, parts[index].name if 0 <= index < len(parts) else "", at, value)
    return Trajectory(
        system=system,
        options=options,
        t_end=t_end,
        time=recording.times,
        rows=recording.rows,
        events=from_rows(recording.events, [contact.name for contact in system.contacts]),
        status=NAMES[status],
        message=message,
        control=control,
        statistics={**run.statistics(), "core_seconds": recording.core_seconds, "seconds": seconds},
    )
