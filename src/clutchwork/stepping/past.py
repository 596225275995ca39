"""What happened to a run that is stepped: from where it began, through which steps, with which events."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from clutchwork.declare.layout import EVENT
from clutchwork.results.events import Events, contact_domains, from_rows
from clutchwork.results.external_settings import Held
from clutchwork.run.failure import StoppedEarly
from clutchwork.run.input_schedule import Numbers, Tape
from clutchwork.run.simulation import Job, trajectory

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options
    from clutchwork.results.state import State
    from clutchwork.run.trajectory import Trajectory

Array = NDArray[np.float64]
Outsides = tuple[Held, Mapping[str, Any]]


class Mark(NamedTuple):
    """How much had happened when a state was saved."""

    ends: int
    noted: int
    events: int


class Past:
    """The steps of a run since its begin; no output is kept, the run is repeated where it is asked for."""

    def __init__(self, system: System, start: State | None, begin: float, outside: Outsides) -> None:
        """Parameters: start, the state at the begin, None: the start of the model; begin [s]; what is set there."""
        self._system, self._start, self._begin = system, start, begin
        self._contacts = contact_domains(system)
        self._tape = Tape(*outside)
        self._marks: WeakKeyDictionary[State, Mark] = WeakKeyDictionary()
        self.rows: list[Array] = []  # of events

    def note(self, kind: str, name: str, value: Any, numbers: Numbers) -> None:
        """Something was set."""
        self._tape.noted.append((len(self._tape.ends), kind, name, value, numbers))

    def stepped(self, end: float) -> None:
        """The core has run up to a time."""
        self._tape.ends.append(end)

    @property
    def goal(self) -> float:
        """Time up to which the core was to run last [s]."""
        return self._tape.ends[-1]

    @property
    def events(self) -> Events:
        """What happened to the contacts."""
        return self.events_and(np.empty((0, len(EVENT))))

    def events_and(self, more: Array) -> Events:
        """The same, and rows that follow."""
        return self.named(np.concatenate([np.empty((0, len(EVENT))), *self.rows, np.asarray(more)]))

    def named(self, rows: Array) -> Events:
        """Rows of the core as events."""
        return from_rows(rows, self._contacts)

    def trajectory(self, end: float, options: Options) -> Trajectory:
        """All of it, repeated; how it ended is known to the caller."""
        job = Job(self._system, end, options.changed({"t_start": self._begin}), self._tape.copy(), self._start)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", StoppedEarly)
            return trajectory(job, None)

    def mark(self, state: State) -> None:
        """A state was saved here."""
        self._marks[state] = Mark(len(self._tape.ends), len(self._tape.noted), len(self.rows))

    def back_to(self, state: State) -> bool:
        """Forget what came after a state; False where it is not one of these steps."""
        place = self._marks.get(state)
        if place is None:
            return False
        del self._tape.ends[place.ends :], self._tape.noted[place.noted :], self.rows[place.events :]
        for other in [other for other, later in self._marks.items() if later > place]:
            del self._marks[other]
        return True
