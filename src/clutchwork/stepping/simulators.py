"""Many runs of one driveline that are advanced side by side, and set and read between the steps as arrays."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import row_columns
from clutchwork.base.errors import ModelError, Problem, UseError
from clutchwork.base.plural import counted
from clutchwork.base.quote import quote
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.core import core
from clutchwork.declare.layout import DONE
from clutchwork.declare.options import Options
from clutchwork.results.channels import channels
from clutchwork.results.events import Events, contact_domains, from_rows
from clutchwork.results.state import State
from clutchwork.run.begin import begun, put, seen, state_of
from clutchwork.run.settings import without_end
from clutchwork.run.simulation import Assembles, begin_of, message_of, model_of, refuse_fixed
from clutchwork.stepping.clock import after, in_seconds
from clutchwork.stepping.many_readings import ManyReadings
from clutchwork.stepping.signals import given_by_others, signals, unknown
from clutchwork.stepping.varied import systems_of

if TYPE_CHECKING:
    from clutchwork.declare.option_fields import OptionFields

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]


@explained_methods("sims")
class Simulators:
    """Many runs of one driveline side by side: arrays in, arrays out, on all cores. Each has the bits of a `Simulator`.

    Use them where many closed loops run at once: a policy that learns, a controller against a thousand plants, a
    particle filter. Each run has a number, a time, parameters and a status of its own. With steps of about a
    millisecond, `method="fixed"` and a `step` of that length take a fraction of the time.
    """

    @explained("cw.Simulators")
    def __init__(
        self,
        model: Assembles | System,
        count: int,
        *,
        vary: Mapping[str, ArrayLike] | None = None,
        start: State | None = None,
        threads: int | None = None,
        options: Options | None = None,
        **changes: Unpack[OptionFields],
    ) -> None:
        """Begin so many runs of a Driveline or a System.

        Parameters: count, how many; vary, values by name as `System.changed` takes them, an array of `count` numbers
        each; start, a `State` at which all begin, where nothing varies; threads, by default as many as processors;
        options, an `Options`, or its fields by name, which are those of `simulate`.

        Signals that Python functions give in the model are zero until they are set.
        """
        self._count = _whole("count", count)
        self._threads = _whole("threads", os.cpu_count() or 1 if threads is None else threads)
        self._system = model_of("cw.Simulators", model, options)
        if start is not None and vary:
            raise UseError("cw.Simulators", ["vary needs a new start of every run: give vary or start"])
        given = dict(changes) | (begin_of(self._system, start, changes) if start is not None else {})
        self._options = without_end(self._system.settings, given, options)
        refuse_fixed(self._system, self._options)
        self._own = self._varied("cw.Simulators", vary or {}, self._count)
        self._start = start
        self._runs = [self._begun(number) for number in range(self._count)]
        self._side = core().Side(self._runs)
        self._origin = [run.save() for run in self._runs] if start is not None else None
        self._rows = np.empty((self._count, self._runs[0].row_size))
        self._times = np.array([run.time for run in self._runs])
        self._status = np.full(self._count, DONE, dtype=np.int32)
        self._all = np.arange(self._count)
        self._stale = np.ones(self._count, dtype=bool)
        self._events = np.empty((0, 0))
        self._signals = signals(self._system)
        self._contacts = contact_domains(self._system)

    def _varied(self, call: str, vary: Mapping[str, ArrayLike], count: int) -> list[System]:
        """Systems with other numbers, whose rows are alike."""
        made, sizes = systems_of(self._system, vary, count), row_columns(self._system.counts)
        if any(row_columns(one.counts) != sizes for one in made):
            raise UseError(call, ["values that vary give runs other states: make a Simulators of each kind"])
        return made

    def _begun(self, number: int) -> Any:
        run = begun(self._own[number], self._options, self._start)
        run.expect_inputs(True)
        return run

    # ---------------------------------------------------------------------------------------------------- going on

    @explained("sims.advance")
    def advance(self, duration: float, which: ArrayLike | None = None) -> None:
        """Advance all runs by a time [s], or those of `which`: indices, or a boolean for each.

        A run that cannot go on stays where it ended, and `failed` says so; it does not affect the others.
        """
        step = in_seconds("sims.advance", "duration", duration)
        if step < 0.0:
            raise UseError("sims.advance", [f"duration is {step:g} s: it must not be negative; use sims.restore"])
        chosen = self._chosen("sims.advance", which)
        if self._any_ended():
            chosen = chosen[self._status[chosen] == DONE]
        ends, chosen = self._ends(chosen, step)
        self._events, raised = self._side.advance(chosen, ends, self._rows, self._status, self._threads)
        if raised is not None:
            # some have got there, some have not begun: each stands where it is, and can go on
            self._status[chosen], self._stale[chosen] = DONE, True
            for number in chosen.tolist():
                self._times[number] = self._runs[number].time
            raise raised
        there = self._places(chosen)
        self._times[there], self._stale[there] = ends[there], False
        if self._any_ended():
            for number in chosen[self._status[chosen] != DONE].tolist():
                self._times[number], self._stale[number] = self._runs[number].time, True

    def _ends(self, chosen: Numbers, step: float) -> tuple[Array, Numbers]:
        """Where each of these runs ends that goes on by a step, in an array of all; those that get any farther."""
        ends, there = self._times.copy(), self._places(chosen)
        now = self._times[there]
        first, last = (float(now.min()), float(now.max())) if len(now) else (0.0, 0.0)
        # most runs stand at few times
        for time in [first] if first == last else np.unique(now).tolist():
            ends[self._times == time] = after(time, step)
        if (ends[there] > now).all():
            return ends, chosen
        return ends, chosen[ends[chosen] > self._times[chosen]]

    def _any_ended(self) -> bool:
        return bool((self._status != DONE).any())

    def _places(self, chosen: Numbers) -> Any:
        """What selects runs from arrays of all: a slice where these are all."""
        return slice(None) if len(chosen) == self._count else chosen

    # ------------------------------------------------------------------------------------------------------ setting

    @explained("sims.set")
    def set(self, name: str | Mapping[str, ArrayLike], value: ArrayLike | None = None, which: Any = None) -> None:
        """Set a signal from the present time on, or several by name: one number for all, or an array of one for each.

        Parameters: which, numbers of the runs, or whether, for each; then an array has as many numbers as these. It
        holds the value [in its unit] in place of that of the model until it is set again, or until `reset`. ModelError
        names everything wrong at once, and nothing is set then. Parameters are given by `vary`.
        """
        if isinstance(name, Mapping) == (value is not None):
            wanted = "values by name, or one name and its values"
            raise UseError("sims.set", [f"{quote(name)} and {quote(value)} do not fit; give {wanted}"])
        chosen = self._chosen("sims.set", which)
        given: Mapping[Any, Any] = name if isinstance(name, Mapping) else {name: value}
        plan, problems = list[tuple[int, Array]](), list[Any]()
        for one, numbers in given.items():
            values, found = self._read(one, numbers, len(chosen))
            problems += found
            if not found:
                plan += [(place, values) for place in self._signals[one].numbers]
        if problems:
            raise ModelError(problems, self._system.name)
        for place, values in plan:
            self._side.set(chosen, place, values)
        self._stale[self._places(chosen)] = True

    def __setitem__(self, name: str, value: ArrayLike) -> None:
        """The same as `set`."""
        self.set(name, value)

    def _read(self, name: Any, given: Any, count: int) -> tuple[Array, list[Any]]:
        """Values of a signal for so many runs, and what is wrong with them."""
        signal = self._signals.get(name) if isinstance(name, str) else None
        if signal is None:
            linked = given_by_others(self._system, name) if isinstance(name, str) else None
            return np.empty(0), [linked or self._parameter(name) or unknown(self._system, name)]
        array = _array(given)
        if array is None or array.shape not in ((), (count,)):
            wanted = f"give one number, or an array of {counted(count, 'numbers')}"
            shape = "" if array is None else f" of shape {array.shape}"
            raise UseError("sims.set", [f"{quote(name)} is {quote(given)}{shape}: {wanted}"])
        # the ends of the range say whether all are allowed; they are no numbers where one is none
        tried = {float(array.min()), float(array.max())} if array.size else set[float]()
        problems = [problem for one in tried for problem in signal.read(one)[1]]
        return np.ascontiguousarray(array) if array.shape else np.full(count, float(array)), problems

    def _parameter(self, name: Any) -> Problem | None:
        """Why a parameter is not set while runs go on."""
        if not isinstance(name, str) or name not in self._system.parameters:
            return None
        return Problem(name, "", "is a parameter, which a run keeps", remedy="give it by `vary`, here or of `reset`")

    # ------------------------------------------------------------------------------------------------------ reading

    def __len__(self) -> int:
        return self._count

    @property
    def system(self) -> System:
        """The System of all, before anything varies."""
        return self._system

    @property
    def time(self) -> Array:
        """Present time of each run [s]."""
        return self._times.copy()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all signals that can be read."""
        return tuple(channels(self._system, self._options.angles, self._options.work))

    @property
    def failed(self) -> NDArray[np.bool_]:
        """Whether each run has failed; `reset` or `restore` restarts it."""
        return np.asarray(self._status != DONE)

    def message(self, number: int) -> str:
        """Why a run failed; "" for one that can go on."""
        (number,) = self._chosen("sims.message", [number]).tolist()
        status = int(self._status[number])
        return "" if status == DONE else message_of(self._own[number], status, self._runs[number])

    @property
    def events(self) -> dict[int, Events]:
        """What happened to the contacts in the last `advance`, by the number of the run, where anything did."""
        found = self._events[np.argsort(self._events[:, 0], kind="stable")] if len(self._events) else self._events
        numbers = found[:, 0].astype(int) if len(found) else np.empty(0, dtype=int)
        return {
            number: from_rows(found[numbers == number, 1:], self._contacts) for number in np.unique(numbers).tolist()
        }

    def __getitem__(self, name: str | Sequence[str]) -> Any:
        """A signal of all runs at their present times, (count,), or several, (count, names).

        A run that cannot go on has NaN, and "" as the state of a contact. KeyError with near names where there is none.
        """
        if not isinstance(name, str) and not len(name):
            return np.empty((self._count, 0))
        self._refresh()
        now = ManyReadings(self._rows, self.failed, self._own, self._options)
        return now[name] if isinstance(name, str) else np.stack([now[one] for one in name], axis=1)

    def readings(self) -> ManyReadings:
        """All signals at the present times by name, evaluated when they are read; they stay so when the runs go on."""
        self._refresh()
        return ManyReadings(self._rows.copy(), self.failed, list(self._own), self._options)

    def __contains__(self, name: object) -> bool:
        return name in self.names

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def _refresh(self) -> None:
        """Rows of runs that were set since they went on."""
        if not self._stale.any():
            return
        self._side.give()
        for number in np.flatnonzero(self._stale & ~self.failed).tolist():
            self._rows[number] = seen(self._runs[number])[0]
        self._rows[self.failed] = 0.0
        self._stale[:] = False

    # ------------------------------------------------------------------------------------------------------- states

    @explained("sims.reset")
    def reset(self, which: ArrayLike | None = None, vary: Mapping[str, ArrayLike] | None = None) -> None:
        """Restart all runs, or those of `which`: at their start, with nothing set.

        Parameters: vary, other values for these runs, an array of one number for each, in place of those they had.
        """
        chosen = self._chosen("sims.reset", which).tolist()
        self._side.give()
        if vary is not None:
            if self._start is not None:
                raise UseError("sims.reset", ["vary needs a new start of every run, and these begin at a state"])
            for number, own in zip(chosen, self._varied("sims.reset", vary, len(chosen)), strict=True):
                self._own[number] = own
        for number in chosen:
            if self._origin is None:
                self._runs[number] = self._begun(number)
                self._side.put(number, self._runs[number])
            else:
                self._runs[number].restore(self._origin[number])
            self._here(number)

    @explained("sims.save")
    def save(self, number: int) -> State:
        """The complete state of one run, for `restore` here or for a `Simulator` of the same System."""
        (place,) = self._chosen("sims.save", [number]).tolist()
        if self._status[place] != DONE:
            raise UseError(
                "sims.save", [f"run {place} cannot go on, so there is nothing to save: {self.message(place)}"]
            )
        self._side.give()
        return state_of(self._runs[place], self._own[place], ({}, {}))

    @explained("sims.restore")
    def restore(self, state: State, which: ArrayLike | None = None) -> None:
        """Put all runs, or those of `which`, to a state of their own System.

        StateError where it is that of another one; all of them stay where they are then.
        """
        if not isinstance(state, State):
            raise UseError(
                "sims.restore", [f"state is {quote(state)}: give what sims.save(number) or sim.save() returned"]
            )
        chosen = self._chosen("sims.restore", which).tolist()
        for number in chosen:
            state.fits(self._own[number])
        self._side.give()
        for number in chosen:
            put(self._runs[number], self._own[number], state)
            self._here(number)

    def _here(self, number: int) -> None:
        self._times[number], self._status[number], self._stale[number] = self._runs[number].time, DONE, True

    def _chosen(self, call: str, which: Any) -> Numbers:
        """Numbers of runs that a call means."""
        if which is None:
            return self._all
        given = np.asarray(which)
        if given.dtype == bool and given.shape == (self._count,):
            return np.flatnonzero(given)
        numbers = given.reshape(-1)
        fits = given.size == 0 or (
            given.dtype.kind in "iu" and -self._count <= numbers.min() <= numbers.max() < self._count
        )
        if not fits or len(set(numbers.tolist())) < numbers.size:
            remedy = f"give numbers from 0 to {self._count - 1}, each once, or {self._count} times whether"
            raise UseError(call, [f"which is {quote(which)}: {remedy}"])
        return np.ascontiguousarray(numbers % self._count, dtype=np.int64)

    def __reduce__(self) -> NoReturn:
        """Refuse to be copied or pickled, with what to do instead."""
        raise UseError("cw.Simulators", ["they cannot be copied or pickled; make them where they are needed"])

    def __repr__(self) -> str:
        ended = int(self.failed.sum())
        status = f", {ended} of them ended" if ended else ""
        return f"<{self._count} Simulators of {quote(self._system.name)}{status}>"


def _whole(name: str, value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < 1:
        raise UseError("cw.Simulators", [f"{name} is {quote(value)}: give a whole number from 1"])
    return int(value)


def _array(given: Any) -> Array | None:
    try:
        return np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        return None
