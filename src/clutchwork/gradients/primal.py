"""A run with derivatives, before its derivatives are used: rows, events, steps, and where each step begins and ends."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.gradients.functional import Functional
from clutchwork.gradients.steps import Steps

if TYPE_CHECKING:
    from clutchwork.results.forms import Form

Array = NDArray[np.float64]
Places = NDArray[np.intp]

# kinds of what is between two steps
SMOOTH, EVENT, KNOT, KINK = range(4)


@dataclass(frozen=True, eq=False)
class Knots:
    """Knots of signals whose times are free: when they are, and the derivatives of that by all numbers."""

    times: Array  # s
    moved: Array  # a line for each knot


@dataclass(frozen=True, eq=False)
class Primal:
    """Rows and events of a run at a point."""

    times: Array  # s, instants of the rows
    rows: Array
    events: Array  # as layout.EVENT
    grazes: Array  # time, kind of guard, component, index, difference
    knots: Knots
    steps: Steps
    forms: Mapping[str, Form]  # of the signals that are asked for
    bent: Mapping[str, Array]  # derivatives of signals in all rows by numbers that are in their forms
    numbers: int  # by which is differentiated
    speeds: slice  # of all shafts, in a row
    accelerations: slice
    t_end: float  # s

    def functional(self) -> Functional:
        """One without weights."""
        return Functional(np.zeros(self.numbers))

    def row(self, time: float) -> int:
        """The row of an instant."""
        return int(np.searchsorted(self.times, time))

    # ----------------------------------------------------------------------------------------------- between two steps

    @cached_property
    def between(self) -> tuple[Places, Places]:
        """What each step begins with: its kind, and the number of the event or the knot."""
        kinds, which = np.full(len(self.steps), SMOOTH, dtype=np.intp), np.full(len(self.steps), -1, dtype=np.intp)
        met = [(KINK, float(time), -1) for time in self.grazes[:, 0]]
        met += [(KNOT, float(time), number) for number, time in enumerate(self.knots.times)]
        met += [(EVENT, float(time), number) for number, time in enumerate(self.events[:, 0])]
        for kind, time, number in met:
            place = self._nearest(time)
            if place > 0:
                kinds[place], which[place] = kind, number
        return kinds, which

    def _nearest(self, time: float) -> int:
        """The step that begins nearest to an instant."""
        begins = self.steps.begin
        place = int(np.searchsorted(begins, time))
        near = [one for one in (place - 1, place) if 0 <= one < len(begins)]
        return min(near, key=lambda one: abs(float(begins[one]) - time)) if near else 0
