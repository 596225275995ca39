"""A model at one instant: where it stands, and the derivatives of all its components there."""

from __future__ import annotations

import math
import os
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import Wiring, wiring
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import UseError
from clutchwork.base.shown import shown
from clutchwork.declare.layout import MODES
from clutchwork.declare.options import DEFAULTS, Options
from clutchwork.declare.status import DONE
from clutchwork.results.channels import channels
from clutchwork.results.trajectory import SimulationError, Trajectory
from clutchwork.run.control import Control, controllers
from clutchwork.run.failure import StoppedEarly
from clutchwork.run.record import Recording, record
from clutchwork.run.simulation import Job, new_run, simulate, told

if TYPE_CHECKING:
    from collections.abc import Sequence

    from clutchwork.results.events import Event

Array = NDArray[np.float64]

CALL = "linearise"

# an event within this part of the time, or of a second, is at the instant
BESIDE = 1e-12
# how far past such an event a run may have to go
PAST_EVENT = (1e-15, 1e-13, 1e-11, 1e-9)


@dataclass(frozen=True, eq=False)
class Instant:
    """The right limit at one instant: the row of output, and the derivatives of the components with modes held."""

    system: System
    time: float  # s
    row: Array
    local: Array  # cw_local of c_api.h
    events: tuple[Event, ...] = ()  # at this very instant

    @property
    def wiring(self) -> Wiring:
        """Who is joined to what."""
        return wiring(self.system)

    def part(self, name: str) -> Array:
        """A part of the row, by its name in layout.ROW."""
        return self.row[self.wiring.columns[name]]

    @property
    def modes(self) -> NDArray[np.intp]:
        """Mode of each contact, a number of layout.MODES."""
        return self.part("contact_mode").astype(int)


def instant_of(model: Any, at: Any) -> Instant:
    """A model at its start or at a time [s], or a run at a time [s]; UseError for anything else."""
    problems = list(_problems(model, at))
    if problems:
        raise UseError(CALL, problems)
    if isinstance(model, Trajectory):
        return _of_run(model, float(at))
    system = model if isinstance(model, System) else model.assemble()
    if at is None or float(at) == 0.0:
        return _start(system)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StoppedEarly)
        run = simulate(system, float(at))
    return _of_run(run.raise_for_status(), float(at))


def _problems(model: Any, at: Any) -> Any:
    if isinstance(model, str | os.PathLike):
        yield f"{shown(model)} is not a model; load a file with cw.Driveline.load({os.fspath(model)!r})"
    elif not isinstance(model, System | Trajectory) and not hasattr(model, "assemble"):
        yield f"{shown(model)} is not a model; give a Driveline, a System, or a run with at=..."
    if at is None:
        if isinstance(model, Trajectory):
            yield "at is missing; give the time of the run in s, such as at=1.2"
        return
    if isinstance(at, bool) or not isinstance(at, int | float | np.number) or not math.isfinite(at) or at < 0.0:
        yield f"at = {shown(at)}: must be a time in s, zero or later"
    elif isinstance(model, Trajectory) and len(model) and at > _reached(model):
        yield f"at = {at:g} s is after the end of the run at {_reached(model):g} s; give an instant before it"


def _reached(run: Trajectory) -> float:
    """How far a run came [s]."""
    return run.t_end if run.finished else float(run.time[-1])


def _start(system: System) -> Instant:
    run = _brought(system, DEFAULTS, _control(system), 0.0)
    return _read(system, run.run, ())


def _control(system: System) -> Control:
    return Control(controllers(system.inputs), lambda: channels(system, True, True))


def _of_run(trajectory: Trajectory, at: float) -> Instant:
    """A run at an instant: it is repeated up to there, bit for bit, and what controllers decided is replayed."""
    system, made = trajectory.system, getattr(trajectory.repeat, "__self__", None)
    control = (
        made.control
        if isinstance(made, Job)
        else Control(controllers(system.inputs), lambda: channels(system, True, True))
    )
    recording = _brought(system, trajectory.options, control, at)
    run = recording.run
    near = BESIDE * max(1.0, at)
    # those of the start are how the contacts were told apart
    events = [event for event in trajectory.events.changes() if event.time > 0.0 and abs(event.time - at) <= near]
    instant = _read(system, run, tuple(events))
    # a run that ends at an event may stop right before it
    for step in PAST_EVENT:
        if all(MODES[int(instant.modes[n])] == mode for n, mode in _after(system, events).items()):
            break
        record(recording, at + step * max(1.0, at), np.array([]), control, None)
        instant = _read(system, run, tuple(events))
    return instant


def _brought(system: System, options: Options, control: Control, at: float) -> Recording:
    """A run of the core that has reached a time [s]."""
    recording = Recording(new_run(system.to_bytes()), 0)
    recording.row_size = recording.run.row_size
    for name, value in options.core_options().items():
        recording.run.set_option(name, value)
    record(recording, at, np.array([at]), control, None)
    if recording.raised is not None:
        raise recording.raised
    if recording.status != DONE:
        raise SimulationError(_why(system, recording.status, recording.run))
    return recording


def _after(system: System, events: Sequence[Event]) -> dict[int, str]:
    """How contacts are after events, by their numbers."""
    names = [contact.name for contact in system.contacts]
    return {names.index(event.element): event.after for event in events}


def _read(system: System, run: Any, events: tuple[Event, ...]) -> Instant:
    status, row, local = run.local()
    if status != DONE:
        raise SimulationError(_why(system, status, run))
    return Instant(system, float(run.time), np.asarray(row), np.asarray(local), events)


def _why(system: System, status: int, run: Any) -> str:
    index, time, value, column = run.detail()
    return told(system, status, index, time, value, max(column, 0))
