"""Run a System and collect what it does."""

from __future__ import annotations

import os
import time
import warnings
from collections.abc import Mapping
from contextlib import AbstractContextManager, closing, nullcontext
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol, Unpack

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.base import OptionError, UseError, caller, dataclass, quote
from clutchwork.base.arrays import Array
from clutchwork.declare.calls import explained
from clutchwork.declare.layout import DONE, INTERRUPTED, NOT_FINITE, REFUSED, STATUSES
from clutchwork.declare.options import Options, instants
from clutchwork.results.events import contact_domains, from_rows
from clutchwork.run.begin import advance, begun, reach, row_of, state_of
from clutchwork.run.control import Control, controllers, guests_of, refuse_guests
from clutchwork.run.jumps import jump_times
from clutchwork.run.record import Progress, Recording, Told, record
from clutchwork.run.settings import merged, refuse_endless
from clutchwork.run.trajectory import SimulationError, Trajectory

if TYPE_CHECKING:
    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields
    from clutchwork.results.channels import Channels
    from clutchwork.results.state import State
    from clutchwork.run.input_schedule import Schedule


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
    course: Schedule
    start: State | None = None

    @property
    def begin(self) -> float:
        """Time at which it begins [s]."""
        return self.options.t_start

    def again(self, times: Any) -> Trajectory:
        """Repeat it on other instants [s]; what controllers decided is replayed, not asked for again.

        None: the bare steps of the solver.
        """
        if times is None:
            bare = self.options.changed({"times": None, "dt": None, "output": "steps"})
            return trajectory(replace(self, options=bare), None)
        from clutchwork.run.failure import StoppedEarly

        wanted = np.sort(np.atleast_1d(np.asarray(instants(times), dtype=float)))
        with warnings.catch_warnings():
            # the owner of the run was warned
            warnings.simplefilter("ignore", StoppedEarly)
            made = trajectory(replace(self, options=self.options.changed({"times": wanted, "dt": None})), None)
        if not made.finished and len(made) < len(wanted):
            warnings.warn(StoppedEarly(made.message, made), stacklevel=caller())
        return made

    def state(self, at: float) -> State:
        """Repeat it up to a time [s], and save what it is there."""
        run = begun(self.system, self.options, self.start)
        done, status = 0, DONE
        for number, stop in enumerate(self.course.stops(self.begin, self.t_end)):
            if run.time >= at or status != DONE:
                break
            self.course.act(run, run.time, number)
            status = advance(run, stop) if at >= stop else reach(run, stop, at)
            done = number + 1
        return state_of(run, self.system, self.course.outside(done))


@explained("simulate")
def simulate(
    model: Assembles | System,
    t_end: Number | None = None,
    *,
    start: State | None = None,
    options: Options | None = None,
    progress: Progress | bool | None = None,
    **changes: Unpack[OptionFields],
) -> Trajectory:
    """Compute the motion of a Driveline or a System from 0, or from t_start or a state on, to t_end.

    Parameters: t_end [s], or with a unit, "500 ms", a point in time, wherever the run begins; start, a `State` of the
    same model, from which the run goes on at the time of it; options, an `Options`, or its fields by name (rtol=, dt=,
    t_start= ...); progress, True for a bar of tqdm in a terminal or a notebook, or a function of (time reached [s],
    t_end [s]) that is called now and then.

    What is left out is that of the settings of the model, `Driveline.simulation`, which a model file holds in its
    [simulation] table; `options` replaces all of them but t_end.

    A fault that its element reports as a warning is a `FaultWarning`. A run that cannot go on warns with `StoppedEarly`
    and returns the trajectory so far, with `status` and `message`.
    A controller that raises ends in `SimulationError`, which holds the trajectory so far too, and so does
    `Interrupted`, the KeyboardInterrupt that Ctrl-C raises.
    """
    system = model_of("simulate", model, options)
    given = {**changes} if t_end is None else {**changes, "t_end": t_end}
    if start is not None:
        given |= begin_of(system, start, given)
    end, chosen = merged(system.settings, given, options)
    refuse_endless(system.inputs, chosen.t_start, end, chosen.max_steps)
    held, changed = (start.held, start.changed) if start else ({}, {})
    if start is not None:
        refuse_guests(system.inputs, held)
    guests = guests_of(system.inputs)
    asked, first = controllers(system.inputs, held, guests), start.before if start else None
    control = Control(asked, partial(_channels, system), held=held, changed=changed, first=first)
    with _followed(progress, chosen.t_start, end) as told, closing(guests) if guests else nullcontext():
        run = trajectory(Job(system, end, chosen, control, start), told)
    if any(event.cause == "fault" for event in run.events):
        from clutchwork.run.failure import report_faults

        report_faults(run)
    return run


def _followed(progress: Any, begin: float, t_end: float) -> AbstractContextManager[Told | None]:
    """Callback for the time reached; None if no progress was requested."""
    if progress is None:
        return nullcontext()
    from clutchwork.base.progress import MEASURED, followed

    return followed(progress, t_end, "simulate", "(time, t_end)", begin, bar_format=MEASURED, unit="s")


def _channels(system: System) -> Channels:
    # loaded where a controller reads a signal
    from clutchwork.results.channels import channels

    return channels(system, True, True)


def model_of(call: str, model: Assembles | System, options: object = None) -> System:
    """The System of a model; UseError where it is none, or where options are none."""
    if options is not None and not isinstance(options, Options):
        raise UseError(call, [f"options is {quote(options)}: it must be cw.Options(...)"])
    if not isinstance(model, System) and not hasattr(model, "assemble"):
        raise UseError(call, [_no_model(model)])
    return model if isinstance(model, System) else model.assemble()


def begin_of(system: System, start: object, given: Mapping[str, Any]) -> dict[str, float]:
    """The time of a state of a System as an option; an error for anything else."""
    from clutchwork.results.state import State

    if not isinstance(start, State):
        remedy = "give what sim.save(), run.state() or cw.State.load(path) returned"
        raise UseError("simulate", [f"start is {quote(start)}: {remedy}"])
    if given.get("t_start") is not None:
        raise OptionError(
            [f"t_start cannot be given beside start: the state is at {start.time:g} s; leave t_start out"]
        )
    start.fits(system)
    return {"t_start": start.time}


def _no_model(given: object) -> str:
    remedy = "give a Driveline or a System"
    if isinstance(given, str | os.PathLike):
        remedy = f"load a file with cw.Driveline.load({os.fspath(given)!r})"
    return f"{quote(given)} is not a model; {remedy}"


def trajectory(job: Job, progress: Told | None) -> Trajectory:
    """Run, and report how it ended."""
    started = time.perf_counter()
    recording, failure = _collect(job, progress)
    made = _named(job, recording, time.perf_counter() - started)
    if failure is not None:
        raise SimulationError(str(failure), made) from failure.__cause__
    if isinstance(recording.raised, KeyboardInterrupt):
        from clutchwork.run.failure import Interrupted

        raise Interrupted(made.message, made) from None
    if recording.raised is not None:
        raise recording.raised
    if not made.finished:
        from clutchwork.run.failure import StoppedEarly

        warnings.warn(StoppedEarly(made.message, made), stacklevel=caller())
    return made


def _collect(job: Job, progress: Told | None) -> tuple[Recording, SimulationError | None]:
    """Record a run; smooth output is that of its steps and of instants between them, so that none are far apart.

    Where that is not so, as with steps of one length, which pass over jumps, the run is repeated on a grid.
    """
    grid = None
    if job.options.dt is not None or job.options.times is not None:
        from clutchwork.run.grid import output_grid

        grid = output_grid(job.options, job.t_end)
    smooth = grid is None and job.options.output == "smooth"
    spacing = (job.t_end - job.begin) / job.options.points if smooth else 0.0
    first, failure = _once(job, grid, progress, spacing)
    if not spacing or failure is not None or first.status == INTERRUPTED:
        return first, failure
    times, jumps = first.times, jump_times(job.system, job.begin, job.t_end)
    if is_refined(times, spacing, jumps):
        return first, None
    second, failure = _once(job, refined(times, spacing, jumps), None)
    second.core_seconds = first.core_seconds
    if second.status == INTERRUPTED:
        # the bare steps reach further
        first.status, first.raised = INTERRUPTED, second.raised
        return first, None
    if first.status != DONE and second.status == DONE:
        # what stopped the run lies at an instant that the grid does not have
        return first, None
    return second, failure


def _once(
    job: Job, grid: Array | None, progress: Told | None, spacing: float = 0.0
) -> tuple[Recording, SimulationError | None]:
    run = begun(job.system, job.options, job.start)
    # what was stepped or goes on from a state is looked at without a trace
    plain = job.start is None and isinstance(job.course, Control)
    recording = Recording(run, job.start is not None, None if plain else partial(row_of, run))
    try:
        record(recording, job.t_end, grid, job.course, progress, spacing)
    except SimulationError as error:
        return recording, error
    except KeyboardInterrupt as error:
        # between two calls of the core
        recording.status, recording.raised = INTERRUPTED, error
    return recording, None


def is_refined(times: Array, spacing: float, jumps: Array) -> bool:
    """Whether there are both limits at every jump, and no two instants further apart than the spacing.

    The core adds up the periods of a signal in its own way, so that its instants are those of Python within round-off.
    """
    if times.size < 2:
        return not times.size or not np.any(jumps <= times[-1])
    round_off = 4.0 * np.spacing(np.abs(times[-1]))
    if (times[1:] - times[:-1]).max() > spacing * (1.0 + 1e-9) + round_off:
        return False
    reached = jumps[jumps < times[-1]]
    present = np.searchsorted(times, reached + round_off, "right") - np.searchsorted(times, reached - round_off, "left")
    return bool((present >= 2).all())


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


def message_of(system: System, status: int, run: Any) -> str:
    """Why a run stopped. What is not finite is an element, or a number of a row; else the largest one is named."""
    index, at, value, column = run.detail()
    if status == NOT_FINITE and not names_part(system, index) and column < 0:
        row = np.asarray(run.row())
        column = int(np.argmax(np.abs(row)))
        value = float(row[column])
    return told(system, status, index, at, value, column)


def refuse_fixed(system: System, options: Options) -> None:
    """OptionError where the method is "fixed" and does not take a model, before anything runs."""
    if options.method != "fixed":
        return
    run = begun(system, options, None)
    if advance(run, options.t_start) == REFUSED:
        raise OptionError([message_of(system, REFUSED, run)])


def names_part(system: System, index: int) -> bool:
    """Whether a number is that of an element or a contact."""
    return 0 <= index < len(acting(system))


def acting(system: System) -> list[Any]:
    """The elements and contacts by the numbers that the core has for them: one of several ways has one for each."""
    from clutchwork.assembly.wiring import wiring

    known = wiring(system)
    return [branch.component for branch in (*known.elements, *known.contacts)]


def told(system: System, status: int, index: int, at: float, value: float, column: int) -> str:
    """Why a run stopped at a time: an element or contact by its number, and its value, or a number of the row."""
    from clutchwork.run.failure import explain, jam_of

    parts = acting(system)
    if STATUSES[status] == "zeno" and index < 0:
        number = int(value)
        if number >= len(system.inputs):
            crowded = (*system.processes, *system.flows)
            return explain(status, crowded[number - len(system.inputs)], at, value)
        return explain(status, None, at, value, system.inputs[number].name)
    if status != NOT_FINITE or names_part(system, index):
        part = parts[index] if names_part(system, index) else None
        jam = jam_of(system, part, index) if part is not None and STATUSES[status] == "jammed" else ""
        return explain(status, part, at, value, jam=jam)
    from clutchwork.assembly.wiring import wiring
    from clutchwork.results.rows import numbers

    name, _ = numbers(wiring(system))[column]
    return explain(status, None, at, value, name)


def _named(job: Job, recording: Recording, seconds: float) -> Trajectory:
    """The numbers of a run with the names of its system."""
    run, status, system = recording.run, recording.status, job.system
    message = ""
    if status != DONE:
        message = message_of(system, status, run)
    if status == REFUSED:
        raise OptionError([message])
    return Trajectory(
        system=system,
        options=job.options,
        t_end=job.t_end,
        time=recording.times,
        rows=recording.rows,
        events=from_rows(recording.events, contact_domains(system)),
        status=STATUSES[status],
        message=message,
        repeat=job.again,
        lacks=(),
        capture=job.state,
        start=job.start,
        course=job.course,
        statistics={**recording.counts(), "core_seconds": recording.core_seconds, "seconds": seconds},
    )
