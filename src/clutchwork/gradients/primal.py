"""A run with derivatives, before its derivatives are used: rows, events, steps, and where each step begins and ends."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.gradients.functional import Functional
from clutchwork.gradients.grazing import decided
from clutchwork.gradients.steps import Steps

if TYPE_CHECKING:
    from clutchwork.results.forms import Form
    from clutchwork.sweeps.outputs import Output

Array = NDArray[np.float64]
Places = NDArray[np.intp]

# parts of a row whose rates do not jump where torques bend
INTEGRATED = (
    *("speed", "angle", "state", "element_work", "contact_work", "prescribed_work", "supply_energy", "meter_energy"),
)
# instants that are as close are one, of a second or of their size
SAME = 1e-12
# kinds of what is between two steps
SMOOTH, EVENT, KNOT, KINK = range(4)


@dataclass(frozen=True, eq=False)
class Knots:
    """Knots of signals: when they are, and of those whose times are free the derivatives of that by all numbers."""

    times: Array  # s, of those that move
    moved: Array  # a line for each of them
    meets: Array  # s, where one meets another that moves otherwise, or an end of the run
    known: Array  # s, of all


@dataclass(frozen=True, eq=False)
class Primal:
    """Rows and events of a run at a point."""

    times: Array  # s, instants of the rows
    rows: Array
    events: Array  # as layout.EVENT
    grazes: Array  # time, kind of guard, component, index, difference
    knots: Knots
    steps: Steps
    by_rows: Mapping[Output, float]  # what a run without derivatives says: squared jerks, extremes in short steps
    forms: Mapping[str, Form]  # of the signals that are asked for
    bent: Mapping[str, Array]  # derivatives of signals in all rows by numbers that are in their forms
    numbers: int  # by which is differentiated
    columns: Mapping[str, slice]  # parts of a row
    kinds: Sequence[str]  # of each number of a row its part
    t_end: float  # s
    rtol: float  # relative tolerance of the run, to which rows inside of its steps are known

    def functional(self) -> Functional:
        """One without weights."""
        return Functional(np.zeros(self.numbers))

    def row(self, time: float) -> int:
        """The row of an instant."""
        return int(self.times.searchsorted(time))

    @cached_property
    def decided(self) -> Array:
        """Guards that decided about contacts, of those that hardly did or met others."""
        return decided(self.grazes, self.events)

    @cached_property
    def is_smooth(self) -> NDArray[np.bool_]:
        """Which numbers of a row are integrals."""
        found = np.zeros(max(part.stop for part in self.columns.values()), dtype=bool)
        for name in INTEGRATED:
            found[self.columns[name]] = True
        return found

    def bends_at(self, columns: Places, times: Array) -> NDArray[np.bool_]:
        """Whether a moving knot gives these columns a kink or a jump at each of the instants."""
        if not len(self.knots.times) and not len(self.knots.meets):
            return np.zeros(len(times), dtype=bool)
        knots = np.r_[self.knots.times, self.knots.meets]
        jumps = self.grazes[self.grazes[:, 1] < 0, 0]
        # speeds and energies follow torques that bend, but do not bend with them
        met = np.intersect1d(knots, jumps) if np.all(self.is_smooth[columns]) else knots
        room = SAME * (1.0 + np.abs(times))
        found: NDArray[np.bool_] = np.any(np.abs(times[:, None] - met) <= room[:, None], axis=1)
        return found

    # ----------------------------------------------------------------------------------------------- between two steps

    @cached_property
    def between(self) -> tuple[Places, Places]:
        """What each step begins with: its kind, and the number of the instant that moves, -1 of a knot that stays."""
        # at a knot that stays a signal may jump by nothing
        kinds = np.where(_are_among(self.steps.begin, self.knots.known), KNOT, SMOOTH)
        which = np.full(len(self.steps), -1, dtype=np.intp)
        # guards are numbered behind the events
        guards = enumerate(self.grazes[:, [0, 1, 3]].tolist(), len(self.events))
        met = [
            (KNOT, time, -1) if what < 0 else (KINK, time, number)
            for number, (time, what, index) in guards
            if what < 0 or index < np.inf
        ]
        met += [(KNOT, float(time), number) for number, time in enumerate(self.knots.times)]
        met += [(EVENT, float(time), number) for number, time in enumerate(self.events[:, 0])]
        for kind, time, number in met:
            place = self._nearest(time)
            # the first step begins at an event where what is before that is too short to be one
            if place > 0 or (kind == EVENT and self._begins_at(time)):
                kinds[place], which[place] = kind, number
        return kinds, which

    @cached_property
    def stays(self) -> NDArray[np.bool_]:
        """Whether each step begins with a knot that does not move."""
        found: NDArray[np.bool_] = self.between[0] == KNOT
        return found & ~_are_among(self.steps.begin, self.knots.times)

    @cached_property
    def meets(self) -> list[tuple[float, int]]:
        """Instants [s] at which a knot meets one that moves differently, and the steps that begin there."""
        ends = np.r_[self.steps.begin, self.steps.end[-1:]]
        return [(float(time), int(np.argmin(np.abs(ends - time)))) for time in self.knots.meets] if len(ends) else []

    def _begins_at(self, time: float) -> bool:
        """Whether the first step begins at an instant."""
        return len(self.steps) > 0 and abs(float(self.steps.begin[0]) - time) <= SAME * (1.0 + abs(time))

    def _nearest(self, time: float) -> int:
        """The step that begins nearest to an instant."""
        begins = self.steps.begin
        place = int(np.searchsorted(begins, time))
        near = [one for one in (place - 1, place) if 0 <= one < len(begins)]
        return min(near, key=lambda one: abs(float(begins[one]) - time)) if near else 0


def _are_among(times: Array, others: Array) -> NDArray[np.bool_]:
    """Whether each of some instants is one of others."""
    known = np.r_[-np.inf, np.sort(others), np.inf]
    place = np.searchsorted(known[:-1], times)
    away = np.minimum(np.abs(known[place] - times), np.abs(times - known[np.maximum(place - 1, 0)]))
    found: NDArray[np.bool_] = away <= SAME * (1.0 + np.abs(times))
    return found
