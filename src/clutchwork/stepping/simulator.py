"""A run that is advanced step by step, and set and read between the steps."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import inf, isfinite
from numbers import Real
from typing import TYPE_CHECKING, Any, Unpack
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.system import System
from clutchwork.base.errors import ModelError, UseError
from clutchwork.base.shown import shown
from clutchwork.declare.calls import explained
from clutchwork.declare.layout import CAUSES, EVENT
from clutchwork.declare.options import Options
from clutchwork.declare.status import DONE, EVENTS_FULL
from clutchwork.results.channels import Channels, channels
from clutchwork.results.events import Events, from_rows
from clutchwork.results.forms import Column
from clutchwork.results.state import State
from clutchwork.results.trajectory import SimulationError, Trajectory
from clutchwork.run.begin import begun, choose, put, row_of, state_of
from clutchwork.run.control import Controller, Readings, controllers, instants, is_due
from clutchwork.run.course import Act, Numbers, Tape
from clutchwork.run.failure import StoppedEarly, warn_of_faults
from clutchwork.run.settings import without_end
from clutchwork.run.simulation import Assembles, Job, begin_of, message_of, model_of, trajectory
from clutchwork.stepping.outside import Outside

if TYPE_CHECKING:
    from clutchwork.declare.option_fields import OptionFields

Array = NDArray[np.float64]
CAUSE = next(column for column, (name, _) in enumerate(EVENT) if name == "cause")
FAULT = next(number for number, (word, _) in CAUSES.items() if word == "fault")
# two instants that are closer are one, as a share of them
ROUND_OFF = 1e-12


class Simulator:
    """A run that goes on when it is told to: `advance` by a time, `set` what acts on it, read what it does.

    Use it where something outside of the model decides: a controller, a user, another simulator. Where all is known
    before, `simulate` does it in one call. Between the steps everything is as in `simulate`: contacts lock and let go
    inside of a step, controllers of the model act at their instants, signals follow their tables until they are set.
    """

    @explained("cw.Simulator")
    def __init__(
        self,
        model: Assembles | System,
        *,
        start: State | None = None,
        options: Options | None = None,
        **changes: Unpack[OptionFields],
    ) -> None:
        """Begin at the start of a Driveline or a System, or at a state of it.

        Parameters: start, a `State` of the same model; options, an `Options`, or its fields by name (rtol=, t_start=,
        ...), which are those of `simulate`.
        """
        self._system = model_of("cw.Simulator", model, options)
        given = dict(changes) | (begin_of(self._system, start, changes) if start is not None else {})
        self._options = without_end(self._system.settings, given, options)
        self._run = begun(self._system, self._options, start)
        self._run.expect_inputs(True)
        self._instant, self._rows = np.empty(1), np.empty((1, self._run.row_size))
        self._readers: dict[str, Callable[[], Any]] = {}
        self._marks: WeakKeyDictionary[State, tuple[int, int, int]] = WeakKeyDictionary()
        self._outside = Outside(self._system)
        self._contacts = [contact.name for contact in self._system.contacts]
        self._given = start
        self._begin_at(start, start)
        self._row()
        self._origin, self._first = self.save(), list(self._events)

    # ---------------------------------------------------------------------------------------------------- going on

    @explained("sim.advance")
    def advance(self, duration: float) -> None:
        """Go on by a time [s].

        A time that is a multiple of the duration but for round-off is that multiple. A run that cannot go on is a
        `SimulationError`, with the run so far in `trajectory`; time stands then, until `restore` or `reset`.
        """
        step = _seconds("sim.advance", "duration", duration)
        if step < 0.0:
            raise UseError("sim.advance", [f"duration is {step:g} s: time does not go back; sim.restore(state) does"])
        end = self._time + step
        if step > 0.0:
            # as a decimal, which knots of tables are
            whole = float(f"{round(end / step) * step:.15g}")
            end = whole if _same(whole, end) else end
        self._to(end)

    @explained("sim.advance_to")
    def advance_to(self, time: float) -> None:
        """Go on up to a point in time [s]; errors are those of `advance`."""
        end = _seconds("sim.advance_to", "time", time)
        if end < self._time:
            now = f"before the present time {self._time:.9g} s"
            raise UseError("sim.advance_to", [f"time is {end:.9g} s, {now}; sim.restore(state) goes back"])
        self._to(end)

    def _to(self, end: float) -> None:
        if self._failure is not None:
            raise self._failure
        if not self._controllers:
            if end > self._time:
                self._stretch(end)
            return
        end = next((at for one in self._controllers if _same(at := round(end / one.period) * one.period, end)), end)
        for stop in instants(self._controllers, self._time, end) if end > self._time else ():
            self._control()
            self._stretch(stop)

    def _stretch(self, stop: float) -> None:
        """Let the core run; the row at its end is taken with the same call."""
        run = self._run
        self._instant[0] = stop
        status, filled, raised = run.advance(stop, self._instant, self._rows, 0, 0)
        while status == EVENTS_FULL:
            self._take_events()
            status, more, raised = run.advance(stop, self._instant, self._rows, filled, 0)
            filled += more
        self._untouched = False
        self._stale = filled == 0
        # what is set later does not change what a controller sees just before that time
        self._left = self._rows.copy() if self._sampled else None
        if run.pending:
            self._take_events()
        if raised is not None:
            self._time = run.time
            self._tape.ends.append(self._time)
            raise raised
        self._tape.ends.append(stop)
        if status != DONE:
            self._stop(status)
        self._time = stop

    def _stop(self, status: int) -> None:
        """The core cannot go on: tell why, with the run so far."""
        self._time = self._run.time
        try:
            made = self._trajectory(self._tape.ends[-1])
        except SimulationError as error:
            made = error.trajectory
        self._stale = True
        self._failure = SimulationError(message_of(self._system, status, self._run), made)
        raise self._failure

    def _take_events(self) -> None:
        rows = np.asarray(self._run.events())
        self._events.append(rows)
        if np.any(rows[:, CAUSE] == FAULT):
            warn_of_faults(self._system, from_rows(rows, self._contacts))

    def _control(self) -> None:
        """Call the controllers that are due, once at each instant."""
        if self._called == self._time:
            return
        self._called = self._time
        due = [one for one in self._controllers if is_due(one.period, self._time)]
        if not due:
            return
        readings = Readings(self._channels(), self._row() if self._left is None else self._left)
        for one in due:
            self._apply(Act("control", one.name, None, ((one.index, self._asked(one, readings)),)))

    def _asked(self, controller: Controller, readings: Readings) -> float:
        try:
            return controller.value(self._time, readings)
        except SimulationError as error:
            self._failure = SimulationError(str(error), self.run)
            raise self._failure from error.__cause__

    # ------------------------------------------------------------------------------------------------------ setting

    @explained("sim.set")
    def set(self, name: str | Mapping[str, Any], value: Any = None) -> None:
        """Set a signal or a parameter from the present time on, or several at once by name.

        A signal, such as "c1.pressure", holds the value [in its unit] whatever the model says, until it is set again or
        `release` is called. A parameter, such as "c1.gain" or "c1.friction.static", keeps it too; what a run cannot
        change, such as an inertia, is refused. ModelError names all that is wrong at once, and nothing is set then.
        """
        if isinstance(value, float) and isinstance(name, str):
            known = self._outside.signals.get(name)
            if known is not None and isfinite(value) and known.spec.allows(value):
                value = float(value)
                told = known.told(value)
                for number, one in told:
                    self._run.set_input(number, one)
                self._done(("input", name, value, told))
                self._hold(name, value)
                return
        given = dict(name) if isinstance(name, Mapping) else {name: value}
        if not isinstance(name, Mapping) and value is None:
            raise UseError("sim.set", [f"{shown(name)} has no value; write sim.set({shown(name)}, value)"])
        self._set(given)

    @explained("sim.release")
    def release(self, *names: str) -> None:
        """Let signals follow the model again, and parameters have their value of it; all of them without a name."""
        chosen = names or (*self._outside.held, *self._outside.changed)
        unset = [name for name in chosen if name not in self._outside.held and name not in self._outside.changed]
        if unset:
            known = ", ".join((*self._outside.held, *self._outside.changed)) or "nothing"
            raise UseError("sim.release", [f"{shown(name)} is not set; set is {known}" for name in unset])
        self._set(dict.fromkeys(chosen))

    def _set(self, given: Mapping[Any, Any]) -> None:
        plan = self._outside.plan(given)
        if plan.problems:
            raise ModelError(plan.problems, self._system.name)
        for act in plan.acts:
            self._apply(act)
        self._outside.take(plan)
        self._find_controllers()

    def _apply(self, act: Act) -> None:
        act.apply(self._run)
        self._done(act)

    def _done(self, act: tuple[str, str, Any, Numbers]) -> None:
        self._tape.noted.append((len(self._tape.ends), *act))
        self._stale = True
        if self._untouched:
            # the start is decided anew
            self._events.clear()

    def _hold(self, name: str, value: float) -> None:
        fresh = name not in self._outside.held
        self._outside.held[name] = value
        if fresh and self._sampled:
            self._find_controllers()

    def _find_controllers(self) -> None:
        held = self._outside.held
        self._controllers = controllers(self._system.inputs, held) if self._sampled else ()

    @property
    def held(self) -> dict[str, Any]:
        """What is set from outside: signals and parameters by name, with their values."""
        return {**self._outside.held, **self._outside.changed}

    # ------------------------------------------------------------------------------------------------------ reading

    @property
    def time(self) -> float:
        """Present time [s]."""
        return self._time

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all signals that can be read."""
        return tuple(self._channels())

    @property
    def units(self) -> dict[str, str]:
        """Unit of every signal that can be read."""
        return {name: channel.unit for name, channel in self._channels().items()}

    def __contains__(self, name: object) -> bool:
        return name in self._channels()

    def __getitem__(self, name: str | Sequence[str]) -> Any:
        """A signal at the present time, or an array of several; KeyError with near names where there is none.

        Just after `advance` it is the left limit, as that of a `Trajectory` before an event; after `set` the right one.
        """
        if self._stale:
            self._row()
        if not isinstance(name, str):
            return np.array([self[one] for one in name], dtype=float)
        reader = self._readers.get(name)
        if reader is None:
            reader = self._readers[name] = self._reader(name)
        return reader()

    def _reader(self, name: str) -> Callable[[], Any]:
        form, rows = self._channels()[name].evaluate, self._rows
        if isinstance(form, Column):
            return partial(rows.item, 0, form.index)
        return lambda: form(rows)[0].item()

    def _channels(self) -> Channels:
        return channels(self._system, self._options.angles, self._options.work)

    def _row(self) -> Array:
        if self._stale:
            if self._failure is not None:
                raise self._failure
            self._rows[0] = row_of(self._run, self._system)
            self._stale = False
            if self._run.pending:
                self._take_events()
        return self._rows

    @property
    def events(self) -> Events:
        """What happened to the contacts so far."""
        if self._stale:
            self._row()
        rows = np.concatenate([np.empty((0, len(EVENT))), *self._events])
        return from_rows(rows, self._contacts)

    @property
    def run(self) -> Trajectory:
        """Everything so far as a `Trajectory`, since the start or since `restore`."""
        if self._failure is not None and self._failure.trajectory is not None:
            return self._failure.trajectory
        return self._trajectory(self._time)

    def _trajectory(self, end: float) -> Trajectory:
        job = Job(self._system, end, self._options.changed({"t_start": self._begin}), self._tape.copy(), self._start)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", StoppedEarly)
            return trajectory(job, None)

    # ------------------------------------------------------------------------------------------------------- states

    def save(self) -> State:
        """The complete state at the present time, with all that was set from outside: to go on from it anywhere."""
        if self._failure is not None:
            raise SimulationError(f"there is nothing to save: {self._failure}", self._failure.trajectory)
        state = state_of(self._run, self._system, (self._outside.held, self._outside.changed), self._row().tobytes())
        self._marks[state] = len(self._tape.ends), len(self._tape.noted), len(self._events)
        return state

    @explained("sim.restore")
    def restore(self, state: State) -> None:
        """Go to a state of the same model, of this or another Simulator or run, and go on from there with the same bits.

        `run` and `events` are then those up to there where the state was saved by this Simulator on its way, else they
        begin there. StateError for a state that is damaged or that of another model.
        """
        if not isinstance(state, State):
            remedy = "give what sim.save(), run.state() or cw.State.load(path) returned"
            raise UseError("sim.restore", [f"state is {shown(state)}: {remedy}"])
        mark = self._marks.get(state)
        put(self._run, self._system, state)
        if mark is None:
            choose(self._run, self._options)
            self._begin_at(state, state)
        else:
            self._back_to(state, *mark)

    def reset(self) -> None:
        """Go back to where the Simulator began, with nothing set from outside but what it began with."""
        put(self._run, self._system, self._origin)
        self._begin_at(self._origin, self._given)
        self._events += self._first

    def _begin_at(self, here: State | None, start: State | None) -> None:
        """Everything that is known of the past is forgotten; `start` is what the run is repeated from."""
        self._start, self._begin = start, self._run.time
        self._marks.clear()
        self._tape = Tape(*self._outside.begin(here))
        self._events: list[Array] = []
        self._here(here)

    def _back_to(self, state: State, ends: int, noted: int, events: int) -> None:
        """The past up to a state stays."""
        self._tape.cut(ends, noted)
        del self._events[events:]
        for other, mark in list(self._marks.items()):
            if mark > (ends, noted, events):
                del self._marks[other]
        self._outside.begin(state)
        self._here(state)

    def _here(self, state: State | None) -> None:
        self._time = self._run.time
        self._called = -inf
        self._failure: SimulationError | None = None
        counts = self._run.statistics()
        self._untouched = counts["steps"] + counts["rejected"] == 0
        self._stale = state is None
        self._left: Array | None = None
        if state is not None:
            self._rows[0] = state.values
        self._sampled = bool(controllers(self._system.inputs))
        self._find_controllers()

    def __repr__(self) -> str:
        status = "" if self._failure is None else f", {self._failure}"
        return f"<Simulator of {shown(self._system.name)} at {self._time:g} s{status}>"

    def __setitem__(self, name: str, value: Any) -> None:
        self.set(name, value)

    def __iter__(self) -> Any:
        return iter(self._channels())


def _same(one: float, other: float) -> bool:
    """Whether two times are one within round-off."""
    return abs(one - other) <= ROUND_OFF * other


def _seconds(call: str, name: str, value: object) -> float:
    """A finite time [s]; UseError for anything else."""
    if type(value) is float and isfinite(value):
        return value
    if isinstance(value, bool) or not isinstance(value, Real) or not isfinite(float(value)):
        raise UseError(call, [f"{name} is {shown(value)}: give a number in s"])
    return float(value)
