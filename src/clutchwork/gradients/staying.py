"""What rests on a border that does not move, but would leave it for other numbers: docs/theory/gradients.md (17)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import HOUSING, Branch, wiring
from clutchwork.base.classes import dataclass
from clutchwork.gradients.grazing import APART, COMPONENT, DIFFERENCE, INDEX, KIND, TIME, pieces
from clutchwork.gradients.knots import times_of
from clutchwork.gradients.primal import SAME
from clutchwork.gradients.run_point import Run, RunPoint
from clutchwork.gradients.runs import Runs
from clutchwork.gradients.steps import NO_STEPS
from clutchwork.results.forms import LOCKED

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# what changes by less stays, of the largest speed and of the size of a state
STILL = 1e-9
# of more than two nodes each may be what stays, as the turbine of a converter at stall
PAIR = 2
# so much of a run shows how it begins
SHORT = 1e-6


class Watched(NamedTuple):
    """A number of a component that a border may be over: columns of a row, and their factors."""

    columns: list[int]
    factors: Array

    def of(self, rows: Array) -> Array:
        """It in some rows."""
        found: Array = rows[:, self.columns] @ self.factors
        return found


@dataclass(frozen=True, eq=False)
class Staying:
    """Components of a run that stay on a border of a table or a law."""

    runs: Runs
    point: RunPoint
    run: Run

    def found(self) -> Iterator[tuple[float, str, Mask]]:
        """Since when [s], what is said of it, and the numbers by which it would leave it."""
        for graze in self._candidates():
            numbers = self._leaving(graze)
            if numbers.any():
                name = self._branches[int(graze[COMPONENT])].name
                time = float(graze[TIME])
                why = f"{name} stays at a border of its table or its law at {time:.9g} s, which it leaves for other"
                yield time, f"{why} numbers to one side or the other; move a start value, or that border", numbers

    def _candidates(self) -> list[Array]:
        """Borders that do not move where something is from one instant on, or which it leaves at a knot."""
        grazes = self.run.primal.grazes
        moved = grazes[:, DIFFERENCE] * self.point.sizes.max(initial=0.0) > APART
        known = grazes[np.isin(grazes[:, KIND], pieces()) & (grazes[:, COMPONENT] >= 0) & ~moved]
        if not len(known):
            return []
        # what passes a border leaves it at once, but for a knot
        knots = np.r_[-np.inf, self._knots, np.inf]
        behind = np.searchsorted(knots, known[:, TIME])
        away = np.minimum(knots[behind] - known[:, TIME], known[:, TIME] - knots[behind - 1])
        is_near = away <= SAME * (1.0 + np.abs(known[:, TIME]))
        return [one for one in known[is_near | (known[:, INDEX] == np.inf)] if self._may_stay(one)]

    def _may_stay(self, graze: Array) -> bool:
        """Whether nothing that is known without another run says that it leaves the border, or comes to it, at once."""
        time, begin = float(graze[TIME]), self.runs.wanted.begin
        if graze[INDEX] < np.inf:
            return True
        if abs(time - begin) > SAME * (1.0 + abs(begin)):
            return True
        reach = self.runs.wanted.t_end - begin
        shift = self.run.primal.columns["acceleration"].start - self.run.primal.columns["speed"].start
        rates = [
            one._replace(columns=[column + shift for column in one.columns])
            for one in self._watched(graze)
            if self.run.primal.kinds[one.columns[0]] == "speed"
        ]
        return any(abs(float(one.of(self._start)[0])) * reach <= self._fastest for one in rates)

    def _leaving(self, graze: Array) -> Mask:
        """Numbers that move what stays on a border while it does."""
        watched, times, since = self._watched(graze), self._between, graze[INDEX] == np.inf
        inside = times[times > graze[TIME]] if since else times[times < graze[TIME]][::-1]
        numbers = np.zeros(len(self.point.x), dtype=bool)
        looks = [float(graze[TIME]), *inside.tolist()]
        # most leave at once, which the first instants show
        first = self._rows(looks[:2])
        watched = [one for one in watched if np.ptp(one.of(first)) <= self._least(one, first)]
        rows = self._rows(looks) if watched and since else first
        for one in watched:
            values = one.of(rows)
            changes = np.abs(values[1:] - values[0]) > self._least(one, rows)
            count = int(np.argmax(changes)) if changes.any() else len(changes)
            # the last instant at which it is there
            last = count if since else 1
            if count and not self._is_held(one, rows[last]):
                numbers |= self._moving(one, float(inside[last - 1]), self._least(one, rows))
        return numbers

    def _is_held(self, one: Watched, row: Array) -> bool:
        """Whether contacts that are locked hold it, whatever the numbers."""
        known, columns = wiring(self.runs.task.system), self.run.primal.columns
        if self.run.primal.kinds[one.columns[0]] != "speed":
            return False
        modes = row[columns["contact_mode"]]
        locked = [contact.direction for contact, mode in zip(known.contacts, modes, strict=True) if mode == LOCKED]
        ties = [*locked, *(dict(row.ports.values()) for row in known.gears)]
        matrix, rate = np.zeros((len(known.nodes), len(ties))), np.zeros(len(known.nodes))
        for place, tie in enumerate(ties):
            for node, factor in tie.items():
                matrix[node, place] += factor if node != HOUSING else 0.0
        rate[np.array(one.columns) - columns["speed"].start] = one.factors
        left = rate - matrix @ np.linalg.lstsq(matrix, rate, rcond=None)[0]
        return bool(np.abs(left).max(initial=0.0) <= STILL)

    def _moving(self, one: Watched, time: float, least: float) -> Mask:
        """Numbers that move something at an instant between two events, where nothing jumps."""
        runs = Runs(replace(self.runs.task, outputs={}, labels=(), t_end=time), self.runs.words)
        point = self.point._replace(grid=np.array([time]), steps=NO_STEPS, by_rows={})
        run = runs.forward(point) if self.run.is_forward else runs.taped(point)
        moves = run.primal.functional()
        moves.add(np.array([run.primal.row(time)]), np.array(one.columns), one.factors[None])
        found: Mask = np.abs(run.slope(moves)) * self.point.sizes > least
        return found

    # -------------------------------------------------------------------------------------------------- what is watched

    @cached_property
    def _branches(self) -> Sequence[Branch]:
        known = wiring(self.runs.task.system)
        return [*known.elements, *known.contacts]

    def _watched(self, graze: Array) -> list[Watched]:
        """Its rate, its own states, and of more than two nodes the speed of each."""
        branch, columns = self._branches[int(graze[COMPONENT])], self.run.primal.columns
        first = columns["speed"].start
        nodes = {first + node: factor for node, factor in branch.direction.items() if node != HOUSING}
        found = [Watched(list(nodes), np.array(list(nodes.values())))] if nodes else []
        found += [Watched([columns["state"].start + place], np.ones(1)) for _, _, place in branch.states]
        alone = nodes if len(nodes) > PAIR else ()
        return [*found, *(Watched([column], np.ones(1)) for column in alone)]

    def _least(self, one: Watched, rows: Array) -> float:
        """What counts as no change."""
        is_speed = self.run.primal.kinds[one.columns[0]] == "speed"
        return self._fastest if is_speed else STILL * float(np.abs(rows[:, one.columns]).max(initial=0.0))

    @cached_property
    def _fastest(self) -> float:
        speeds = self.run.primal.rows[:, self.run.primal.columns["speed"]]
        return STILL * (float(np.abs(speeds).max(initial=0.0)) or 1.0)

    # --------------------------------------------------------------------------------------------------------- instants

    @cached_property
    def _knots(self) -> list[float]:
        return times_of(self.point.chart, self.point.words, self.runs.wanted.t_end)

    @cached_property
    def _between(self) -> Array:
        """Instants between all events and knots."""
        begin, end = self.runs.wanted.begin, self.runs.wanted.t_end
        known = np.r_[begin, self._knots, self.run.primal.events[:, 0], self.run.primal.grazes[:, TIME], end]
        ends = np.unique(known[(known >= begin) & (known <= end)])
        wide = np.flatnonzero(np.diff(ends) > SAME * (1.0 + abs(end)))
        found: Array = 0.5 * (ends[wide] + ends[wide + 1])
        return found

    @cached_property
    def _start(self) -> Array:
        """The row with which the run begins."""
        begin = self.runs.wanted.begin
        return self.runs.plain.rows_at(self.point.system, self._columns, np.array([begin]), self._behind(begin))

    @cached_property
    def _columns(self) -> Sequence[int]:
        return range(self.run.primal.rows.shape[1])

    def _rows(self, times: list[float]) -> Array:
        """Rows of a run without derivatives at instants in any order."""
        grid, places = np.unique(times, return_inverse=True)
        found = self.runs.plain.rows_at(self.point.system, self._columns, grid, self._behind(float(grid[-1])))
        return np.asarray(found[places.ravel()])

    def _behind(self, time: float) -> float:
        """An end of a run that has a row at an instant [s]."""
        begin, end = self.runs.wanted.begin, self.runs.wanted.t_end
        return min(end, time + SHORT * (end - begin))
