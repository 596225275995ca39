"""A run that is advanced step by step, and set and read between the steps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import inf, isfinite
from typing import TYPE_CHECKING, Any, NoReturn, Unpack

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.system import System
from clutchwork.base import html
from clutchwork.base.errors import ModelError, UseError
from clutchwork.base.quote import quote
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.layout import DONE, EVENTS_FULL
from clutchwork.declare.options import Options
from clutchwork.results.state import State, StateError
from clutchwork.run.begin import begun, choose, put, seen, state_of
from clutchwork.run.control import Controller, controllers, guests_of, instants, is_due, refuse_guests
from clutchwork.run.failure import warn_of_faults
from clutchwork.run.readings import Readings
from clutchwork.run.settings import without_end
from clutchwork.run.simulation import Assembles, begin_of, message_of, model_of, refuse_fixed
from clutchwork.run.trajectory import SimulationError
from clutchwork.stepping.clock import after, in_seconds, same
from clutchwork.stepping.outside import Outside
from clutchwork.stepping.past import Past
from clutchwork.stepping.readout import Readout

if TYPE_CHECKING:
    from clutchwork.declare.option_fields import OptionFields
    from clutchwork.results.events import Events
    from clutchwork.run.input_schedule import Act, Numbers
    from clutchwork.run.trajectory import Trajectory

Array = NDArray[np.float64]
OF_A_STATE = "give what sim.save(), run.state() or cw.State.load(path) returned"


@explained_methods("sim")
class Simulator:
    """A run that advances step by step: `advance` it by a time, `set` its inputs, read its signals.

    Use it when something outside the model decides: a controller, a user, another simulator. If everything is known
    beforehand, `simulate` does it in one call. Inside a step everything is as in `simulate`: contacts lock and break
    away, controllers of the model act at their instants, signals follow their tables until they are set.
    """

    _time: float  # s
    _called: float  # s, when controllers were called last
    _failure: SimulationError | None  # why it cannot go on
    _left: Array | None  # row just before what is set now
    _ahead: Array | None  # events of what was set, which the core does when it goes on; None: not looked yet
    _controllers: tuple[Controller, ...]

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
        refuse_fixed(self._system, self._options)
        self._run = begun(self._system, self._options, start)
        self._run.expect_inputs(True)
        self._instant, self._readout = np.empty(1), Readout(self._system, self._options, self._run.row_size)
        self._outside = Outside(self._system)
        self._sampled = bool(controllers(self._system.inputs))
        if start is not None:
            refuse_guests(self._system.inputs, start.held)
        self._guests = guests_of(self._system.inputs)
        self._start = start
        self._begin(start, start)
        self._row()
        self._origin = self.save()

    # ---------------------------------------------------------------------------------------------------- going on

    @explained("sim.advance")
    def advance(self, duration: float) -> None:
        """Advance by a time [s].

        A time within round-off of a multiple of the duration is set to that multiple. A run that cannot go on raises
        `SimulationError`, with the run so far in `trajectory`, and stays at its time until `restore` or `reset`.
        """
        step = in_seconds("sim.advance", "duration", duration)
        if step < 0.0:
            raise UseError("sim.advance", [f"duration is {step:g} s: it must not be negative; use sim.restore(state)"])
        self._to(after(self._time, step))

    @explained("sim.advance_to")
    def advance_to(self, time: float) -> None:
        """Advance to a point in time [s]; errors are those of `advance`."""
        end = in_seconds("sim.advance_to", "time", time)
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
        end = next((at for one in self._controllers if same(at := round(end / one.period) * one.period, end)), end)
        for stop in instants(self._controllers, self._time, end) if end > self._time else ():
            self._control()
            self._stretch(stop)

    def _stretch(self, stop: float) -> None:
        """Let the core run; the row at its end is taken with the same call."""
        run, rows = self._run, self._readout.rows
        self._instant[0] = stop
        status, filled, raised = run.advance(stop, self._instant, rows, 0, 0)
        while status == EVENTS_FULL and raised is None:
            self._take_events()
            status, more, raised = run.advance(stop, self._instant, rows, filled, 0)
            filled += more
        self._stale, self._ahead = filled == 0, None
        # what is set later does not change what a controller sees just before that time
        self._left = rows.copy() if self._sampled else None
        if run.pending:
            self._take_events()
        if status == DONE and raised is None:
            self._time = stop
            self._past.stepped(stop)
        else:
            self._stop(status, stop, raised)

    def _stop(self, status: int, stop: float, raised: BaseException | None) -> None:
        """The core did not get there: say why, with the run so far. After Ctrl-C it can go on."""
        self._time, self._stale, self._ahead = self._run.time, True, None
        self._past.stepped(self._time if raised is not None else stop)
        if raised is not None:
            raise raised
        raise self._failed(SimulationError(message_of(self._system, status, self._run), self._repeated()))

    def _repeated(self) -> Trajectory | None:
        """The run up to where it failed."""
        try:
            return self._past.trajectory(self._past.goal, self._options)
        except SimulationError as error:
            return error.trajectory

    def _failed(self, error: SimulationError) -> SimulationError:
        """Remember that the run cannot go on."""
        self._failure = error
        return error

    def _take_events(self) -> None:
        rows = np.asarray(self._run.events())
        self._past.rows.append(rows)
        warn_of_faults(self._system, self._past.named(rows))

    def _control(self) -> None:
        """Call the controllers that are due, once at each instant."""
        due = [one for one in self._controllers if is_due(one.period, self._time)]
        if not due or self._called == self._time:
            return
        self._called = self._time
        readings = Readings(self._readout.channels, self._row() if self._left is None else self._left)
        for one in due:
            numbers = ((one.index, self._asked(one, readings)),)
            self._run.set_input(*numbers[0])
            self._done("control", one.name, None, numbers)

    def _renew_guests(self) -> None:
        """FMUs begin anew where they are asked again."""
        if self._guests is not None:
            self._guests.renew()

    def _asked(self, controller: Controller, readings: Readings) -> float:
        try:
            return controller.value(self._time, readings)
        except SimulationError as error:
            self._renew_guests()
            raise self._failed(SimulationError(str(error), self.run)) from error.__cause__

    # ------------------------------------------------------------------------------------------------------ setting

    @explained("sim.set")
    def set(self, name: str | Mapping[str, Any], value: Any = None) -> None:
        """Set a signal or a parameter from the present time on, or several at once by name.

        A signal, such as "c1.pressure", holds the value [in its unit] in place of that of the model, until it is set
        again or released. It follows a `cw.Table` over the time of the run [s], from the present time on, which has at
        most as many pieces ahead as the model has for that signal. A parameter, such as "c1.gain" or
        "c1.friction.static", keeps its value too; what a run cannot change, such as an inertia, is refused. ModelError
        names everything wrong at once, and nothing is set then.
        """
        if isinstance(value, float) and isinstance(name, str):
            known, number = self._outside.signals.get(name), float(value)
            if known is not None and isfinite(number) and known.spec.allows(number) and self._failure is None:
                numbers = known.told(number)
                for place, one in numbers:
                    self._run.set_input(place, one)
                self._done("input", name, number, numbers)
                fresh = name not in self._outside.held
                self._outside.held[name] = number
                if fresh:
                    self._find_controllers()
                return
        if not isinstance(name, Mapping) and value is None:
            raise UseError("sim.set", [f"{quote(name)} has no value; write sim.set({quote(name)}, value)"])
        self._set(name if isinstance(name, Mapping) else {name: value})

    def __setitem__(self, name: str, value: Any) -> None:
        """The same as `set`."""
        self.set(name, value)

    @explained("sim.release")
    def release(self, *names: str) -> None:
        """Return signals and parameters to the values of the model; all of them without a name."""
        held = self.held
        unset = [name for name in names if name not in held]
        if unset:
            known = ", ".join(held) or "nothing"
            raise UseError("sim.release", [f"{quote(name)} is not set; set is {known}" for name in unset])
        self._set(dict.fromkeys(names or held))

    def _set(self, given: Mapping[Any, Any]) -> None:
        plan = self._outside.plan(given, self._time)
        if self._failure is not None:
            raise self._failure
        if plan.problems:
            raise ModelError(plan.problems, self._system.name)
        for act in plan.acts:
            self._apply(act)
        self._outside.take(plan)
        self._find_controllers()

    def _apply(self, act: Act) -> None:
        act.apply(self._run)
        self._done(*act)

    def _done(self, kind: str, name: str, value: Any, numbers: Numbers) -> None:
        self._past.note(kind, name, value, numbers)
        self._stale, self._ahead = True, None

    def _find_controllers(self) -> None:
        self._controllers = controllers(self._system.inputs, self._outside.held, self._guests) if self._sampled else ()

    @property
    def held(self) -> dict[str, Any]:
        """What is set from outside: signals and parameters by name, with their values."""
        return {**self._outside.held, **self._outside.changed}

    # ------------------------------------------------------------------------------------------------------ reading

    @property
    def system(self) -> System:
        """What is run."""
        return self._system

    @property
    def time(self) -> float:
        """Present time [s]."""
        return self._time

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all signals that can be read."""
        return tuple(self._readout)

    @property
    def units(self) -> dict[str, str]:
        """Unit of every signal that can be read."""
        return {name: channel.unit for name, channel in self._readout.channels.items()}

    def __getitem__(self, name: str | Sequence[str]) -> Any:
        """A signal at the present time, or an array of several; KeyError with near names where there is none.

        Just after `advance` it is the left limit, as that of a `Trajectory` before an event; after `set` the right one.
        """
        if self._stale:
            self._row()
        if isinstance(name, str):
            return self._readout[name]
        return np.array([self._readout[one] for one in name], dtype=float)

    def readings(self) -> Readings:
        """All signals at the present time by name, evaluated when read; they do not change later."""
        return Readings(self._readout.channels, self._row().copy())

    def __contains__(self, name: object) -> bool:
        return name in self._readout

    def __iter__(self) -> Iterator[str]:
        return iter(self._readout)

    def _row(self) -> Array:
        """The row at the present time."""
        rows = self._readout.rows
        if self._stale:
            if self._failure is not None:
                raise self._failure
            rows[0], self._ahead = seen(self._run)
            self._stale = False
        return rows

    @property
    def events(self) -> Events:
        """The events so far, including those caused at once by values that were set."""
        if self._failure is not None:
            return self._past.events
        if self._ahead is None:
            self._ahead = np.asarray(seen(self._run)[1])
        return self._past.events_and(self._ahead)

    @property
    def run(self) -> Trajectory:
        """Everything so far as a `Trajectory`: since the start, or since `restore`. The run is repeated for it.

        What was set since the last `advance` shows in it after the next one.
        """
        if self._failure is not None and self._failure.trajectory is not None:
            return self._failure.trajectory
        return self._past.trajectory(self._time, self._options)

    # ------------------------------------------------------------------------------------------------------- states

    def save(self) -> State:
        """The complete state at the present time, with everything that was set from outside."""
        if self._failure is not None:
            raise SimulationError(f"there is nothing to save: {self._failure}", self._failure.trajectory)
        row, left = self._row().tobytes(), b"" if self._left is None else self._left.tobytes()
        outside = self._outside.held, self._outside.changed
        state = state_of(self._run, self._system, outside, row, b"" if left == row else left)
        self._past.mark(state)
        return state

    @explained("sim.restore")
    def restore(self, state: State) -> None:
        """Go to a state of the same model, saved here, by another Simulator or a run, and go on with the same bits.

        `run` and `events` are then those up to there where the state was saved by this Simulator on its way, else they
        begin there. StateError for a state that is damaged or that of another model.
        """
        if not isinstance(state, State):
            raise UseError("sim.restore", [f"state is {quote(state)}: {OF_A_STATE}"])
        refuse_guests(self._system.inputs, state.held)
        before = self._run.save()
        try:
            put(self._run, self._system, state)
        except StateError:
            self._run.restore(before)
            raise
        if self._past.back_to(state):
            self._outside.begin(state)
            self._here(state)
        else:
            choose(self._run, self._options)
            self._begin(state, state)

    def reset(self) -> None:
        """Go back to where the Simulator began, with nothing set from outside but what it began with."""
        put(self._run, self._system, self._origin)
        self._begin(self._origin, self._start)

    def _begin(self, here: State | None, start: State | None) -> None:
        """Forget the past; `start` is what the run is repeated from."""
        self._renew_guests()
        self._past = Past(self._system, start, self._run.time, self._outside.begin(here))
        self._here(here)

    def _here(self, state: State | None) -> None:
        self._time, self._called, self._failure = self._run.time, -inf, None
        self._stale, self._left, self._ahead = state is None, None, None
        if state is not None:
            self._readout.rows[0] = state.values
            self._left = state.before.reshape(1, -1).copy() if self._sampled else None
        self._find_controllers()

    def __reduce__(self) -> NoReturn:
        """Refuse to be copied or pickled, with what to do instead."""
        remedy = "keep the model and the state of sim.save(), and start with cw.Simulator(model, start=state)"
        raise UseError("cw.Simulator", [f"it cannot be copied or pickled; {remedy}"])

    def __repr__(self) -> str:
        status = "" if self._failure is None else f", {self._failure}"
        return f"<Simulator of {quote(self._system.name)} at {self._time:g} s{status}>"

    def _repr_html_(self) -> str:
        """Where it is, and what was set, for a notebook."""
        units, lines = self.units, []
        for name in self.names:
            value = self[name]
            number = value if isinstance(value, str) else f"{value:.6g}"
            lines.append((name, number, units[name], "set" if name in self.held else ""))
        return html.page(html.heading(repr(self)[1:-1]), html.table(("", "value", "unit", ""), lines, right={1}))
