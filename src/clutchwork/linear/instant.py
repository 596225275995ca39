"""A model at one instant: where it stands, and the derivatives of all its components there."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import Wiring, wiring
from clutchwork.base import UseError, dataclass, quote
from clutchwork.base.arrays import Array
from clutchwork.declare.layout import DONE, MODES
from clutchwork.declare.options import Options
from clutchwork.declare.quantity import QuantityError, has_unit, in_si
from clutchwork.results.events import Event
from clutchwork.results.state import State
from clutchwork.run.begin import begun
from clutchwork.run.control import controllers
from clutchwork.run.failure import StoppedEarly
from clutchwork.run.settings import without_end
from clutchwork.run.simulation import simulate, told
from clutchwork.run.trajectory import SimulationError, Trajectory
from clutchwork.stepping.simulator import Simulator

CALL = "linearise"

# an event within this part of the time, or of a second, is at the instant
BESIDE = 1e-12
# how far past such an event a run may have to go
PAST_EVENT = (1e-15, 1e-13, 1e-11, 1e-9)
# a run that is only asked for its start [s]
SHORT = 1e-6


@dataclass(frozen=True, eq=False)
class Instant:
    """The right limit at one instant: the row of output, and the derivatives of the components with modes held."""

    system: System
    time: float  # s
    row: Array
    local: Array  # cw_local of c_api.h
    events: tuple[Event, ...] = ()  # at this very instant
    held: frozenset[str] = frozenset()  # signals that were set from outside

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
    """A model at its start, at a time [s] or at a saved state, a run at a time [s], or a Simulator where it is.

    UseError for anything else.
    """
    at, problems = _plain(at)
    problems = problems or list(_problems(model, at))
    if problems:
        raise UseError(CALL, problems)
    if isinstance(model, Trajectory):
        return _of_run(model, float(at))
    if isinstance(model, Simulator):
        return _at_state(model.system, model.save())
    system = model if isinstance(model, System) else model.assemble()
    if isinstance(at, State):
        return _at_state(system, at)
    begin = options_of(system).t_start
    if at is None or float(at) == begin:
        return _read(system, started(system))
    if float(at) < begin:
        told = f"at = {at:g} s is before t_start = {begin:g} s of the settings of the model, where its run begins"
        raise UseError(CALL, [f"{told}; give a later instant"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StoppedEarly)
        run = simulate(system, float(at))
    return _of_run(run.raise_for_status(), float(at))


def _plain(at: Any) -> tuple[Any, list[str]]:
    """A time that may have a unit, in s."""
    if not has_unit(at):
        return at, []
    try:
        return in_si(at, "s"), []
    except QuantityError as bad:
        return at, [f"at = {quote(at)}: must be a time in s, zero or later ({bad})"]


def _problems(model: Any, at: Any) -> Iterator[str]:
    if isinstance(model, str | os.PathLike):
        yield f"{quote(model)} is not a model; load a file with cw.Driveline.load({os.fspath(model)!r})"
    elif not isinstance(model, System | Trajectory | Simulator) and not hasattr(model, "assemble"):
        yield f"{quote(model)} is not a model; give a Driveline, a System, a Simulator, or a run with at=..."
    if isinstance(model, Simulator):
        if at is not None:
            yield "at cannot be given with a Simulator, whose present time is used; give sim.run for another time"
    elif at is None:
        if isinstance(model, Trajectory):
            yield "at is missing; give the time of the run in s, such as at=1.2"
    elif isinstance(at, State):
        if isinstance(model, Trajectory):
            yield "at is a saved state; give the model that it is of in place of the run"
    elif isinstance(at, bool) or not isinstance(at, int | float | np.number) or not math.isfinite(at) or at < 0.0:
        yield f"at = {quote(at)}: must be a time in s, zero or later"
    elif isinstance(model, Trajectory) and len(model) and at < model.options.t_start:
        yield f"at = {at:g} s is before the begin of the run at {model.options.t_start:g} s; give a later instant"
    elif isinstance(model, Trajectory) and len(model) and at > _end(model):
        yield f"at = {at:g} s is after the end of the run at {_end(model):g} s; give an instant before it"


def _end(run: Trajectory) -> float:
    """How far a run came [s]."""
    return run.t_end if run.finished else float(run.time[-1])


def _of_run(trajectory: Trajectory, at: float) -> Instant:
    run, system, near = reached(trajectory, at), trajectory.system, BESIDE * max(1.0, at)
    begin, held = trajectory.options.t_start, trajectory.state(at=at).held
    # those of the start are how the contacts were told apart
    events = [event for event in trajectory.events.changes() if event.time > begin and abs(event.time - at) <= near]
    instant = _read(system, run, tuple(events), held)
    # a run that ends at an event may stop right before it
    for step in PAST_EVENT:
        if all(MODES[int(instant.modes[n])] == mode for n, mode in _after(system, events).items()):
            break
        step_over(run, at + step * max(1.0, at))
        instant = _read(system, run, tuple(events), held)
    return instant


def _after(system: System, events: Sequence[Event]) -> dict[int, str]:
    """How contacts are after events, by their numbers."""
    names = [contact.name for contact in system.contacts]
    return {names.index(event.element): event.after for event in events}


def _at_state(system: System, state: State) -> Instant:
    return _read(system, started(system, state), (), state.held)


def _read(system: System, run: Any, events: tuple[Event, ...] = (), held: Iterable[str] = ()) -> Instant:
    status, row, local = run.local()
    refuse_stopped(system, run, status)
    return Instant(system, float(run.time), np.asarray(row), np.asarray(local), events, frozenset(held))


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
