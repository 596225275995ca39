"""Runs with derivatives by the core, forward and followed back."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import Wiring, wiring
from clutchwork.base.classes import dataclass
from clutchwork.declare.core import derivatives
from clutchwork.declare.layout import DONE, INTERRUPTED
from clutchwork.gradients.at_limits import holders
from clutchwork.gradients.bent_formulas import formulas
from clutchwork.gradients.functional import Functional
from clutchwork.gradients.knots import knots
from clutchwork.gradients.plain import Detail, PlainRuns
from clutchwork.gradients.primal import Primal
from clutchwork.gradients.refined import WithinSteps
from clutchwork.gradients.resting_loads import followers
from clutchwork.gradients.run_point import Run, RunPoint
from clutchwork.gradients.signals_at import SignalsAt
from clutchwork.gradients.steps import NO_STEPS
from clutchwork.gradients.task import GradientTask
from clutchwork.gradients.watched import knots_and_end
from clutchwork.gradients.words import Slopes, Words
from clutchwork.results.forms import all_reads
from clutchwork.results.gradient import NoGradient
from clutchwork.run.simulation import told
from clutchwork.sweeps.batch import CoreOutputs
from clutchwork.sweeps.outputs import Extreme

Array = NDArray[np.float64]

# memory of a run that is followed back: the first is asked for, what is not written costs nothing
TAPES = (1 << 28, 1 << 31)
# parts of a row that are integrals over time
INTEGRALS = ("angle", "element_work", "contact_work", "prescribed_work", "supply_energy", "meter_energy")
# multiples of it never come again, and spread evenly
TURN = 0.6180339887498949


@dataclass(frozen=True, eq=False)
class Runs:
    """Runs of a driveline with other numbers."""

    task: GradientTask
    known_words: Words | None = None

    @cached_property
    def words(self) -> Words:
        """The words of the driveline as functions of the numbers."""
        return self.known_words or Words(self.task.system, tuple(self.task.parameters))

    @cached_property
    def wanted(self) -> CoreOutputs:
        """The requested outputs of each run."""
        return CoreOutputs.of(self.task.system, self.task.options, self.task.outputs, self.task.t_end)

    @cached_property
    def signals(self) -> SignalsAt:
        """The forms of its signals."""
        return SignalsAt(self.words, self.wanted.all_signals)

    @cached_property
    def _options(self) -> Mapping[str, float]:
        # the method that runs with derivatives have
        return self.task.options.changed({"method": "rodas5p"}).core_options()

    @cached_property
    def plain(self) -> PlainRuns:
        """Runs without derivatives."""
        ones = [one for one in self.wanted.outputs.values() if isinstance(one, Extreme)]
        return PlainRuns(self.wanted, self._options, self.task.threads, WithinSteps.of(self.task.system, ones))

    def sizes(self, x: Array) -> Array:
        """Sizes of the numbers at a point."""
        found: Array = np.maximum(np.abs(x), np.where(x == 0.0, *self._compared))
        return found

    @cached_property
    def _compared(self) -> tuple[Array, Array]:
        # with what changes of the numbers are compared at zero, and elsewhere
        at_zero, elsewhere = ([one.compared(value) for one in self.task.parameters] for value in (0.0, 1.0))
        return np.array(at_zero), np.array(elsewhere)

    # ------------------------------------------------------------------------------------------------- with derivatives

    def point(self, x: Array) -> RunPoint:
        """Prepare a run with derivatives at a point; NoGradient where the plain run stops early."""
        chart, words = self.words.at(x)
        slopes = chart.slopes(x)
        moving = knots(chart, words, slopes, self.wanted.begin, self.wanted.t_end)
        known = x, self.sizes(x), chart, words, slopes, moving
        looked_at = knots_and_end(chart, words, self.wanted.begin, self.wanted.t_end) if self._is_watched else ()
        grid = np.union1d(self.wanted.grid, looked_at) if looked_at else self.wanted.grid
        point = RunPoint(*known, NO_STEPS, np.zeros(0), {}, grid, (), looked_at)
        if not self.plain.in_steps:
            return point
        run, steps, by_rows = self.plain.with_steps(point.system, self.signals.at(x))
        self._refuse_stopped(run.status, run.detail)
        return self._with_grid(point._replace(steps=steps, events=run.events[:, 0], by_rows=by_rows))

    def forward(self, point: RunPoint) -> Run:
        """A run with derivatives by all numbers."""
        places, seeds = point.slopes.places.astype(np.int64), point.slopes.matrix
        status, _, rows, row_tangents, events, event_tangents, grazes, fault = derivatives().tangents(
            point.system, places, seeds, *self._how(point)
        )
        self._refuse_stopped(status, (fault[0], float("nan"), fault[1], -1))
        moved = self._aligned(point, events[:, 0])
        if moved is not None:
            return self.forward(moved)
        slope = partial(_forward, row_tangents, event_tangents)
        primal = self._primal(point, rows, events, grazes)
        return Run(primal, slope, is_forward=True, notes=point.notes, tangents=row_tangents)

    def taped(self, point: RunPoint) -> Run:
        """A run that is followed back from each result; forward where there is no memory for it."""
        places = point.slopes.places.astype(np.int64)
        probes = point.slopes.matrix @ (point.sizes * self._shares)
        for size in TAPES:
            tape = derivatives().Adjoint(point.system, places, probes, *self._how(point), size)
            status, _, rows, events, grazes, fault = tape.found()
            if status != INTERRUPTED:
                break
        else:
            return self.forward(point)
        self._refuse_stopped(status, (fault[0], float("nan"), fault[1], -1))
        moved = self._aligned(point, events[:, 0])
        if moved is not None:
            return self.taped(moved)
        primal = self._primal(point, rows, events, grazes)
        slope = partial(_back, tape, point.slopes, primal.rows.shape, len(events) + len(grazes))
        return Run(primal, slope, is_forward=False, notes=point.notes)

    @cached_property
    def _shares(self) -> Array:
        """Shares of the numbers in one direction of all, never the same for two, by which derivatives take their steps.

        Entries of a table go the same way: a table that is moved up and down excites what none of them does.
        """
        fields = [one.field for one in self.task.parameters]
        order = {field: number for number, field in enumerate(dict.fromkeys(fields), 1)}
        ways = np.array([order[field] * TURN % 1.0 < 0.5 for field in fields], dtype=bool)
        amounts = 0.8 + 0.2 * (TURN * np.arange(1, len(fields) + 1) % 1.0)
        return np.where(ways, -amounts, amounts)

    def _how(self, point: RunPoint) -> tuple[Any, ...]:
        """Instants, options and sizes of both kinds of runs with derivatives."""
        return point.grid, self.wanted.t_end, self._told, self._wiring.row_size, self._has_work

    @cached_property
    def _wiring(self) -> Wiring:
        return wiring(self.task.system)

    @cached_property
    def _is_watched(self) -> bool:
        """Whether anything may rest at a border that no guard watches."""
        return any(found(self.task.system) for found in (followers, holders, formulas))

    @cached_property
    def _told(self) -> list[tuple[str, float]]:
        return list(self._options.items())

    @cached_property
    def _has_work(self) -> bool:
        """Whether any output is made of angles or work; their derivatives are left out elsewhere."""
        columns = self._wiring.columns
        integrals = {place for part in INTEGRALS for place in range(columns[part].start, columns[part].stop)}
        return not integrals.isdisjoint(all_reads(self.signals.plain.values()))

    def _with_grid(self, point: RunPoint) -> RunPoint:
        return point._replace(
            grid=np.unique(np.concatenate([self.wanted.grid, point.looked_at, point.steps.times.ravel()]))
        )

    def _aligned(self, point: RunPoint, events: Array) -> RunPoint | None:
        """The point with other instants of events, where they are too far from those that were expected."""
        if not len(point.steps) or len(events) != len(point.events):
            return None
        nearest = np.abs(point.steps.begin[:, None] - point.events).argmin(axis=0) if len(events) else np.zeros(0, int)
        room = point.steps.room[nearest]
        if np.all(np.abs(events - point.events) <= 0.5 * room):
            return None
        return self._with_grid(point._replace(steps=point.steps.moved(point.events, events), events=events))

    def _primal(self, point: RunPoint, rows: Array, events: Array, grazes: Array) -> Primal:
        return Primal(
            times=point.grid,
            rows=rows,
            events=events,
            grazes=grazes,
            knots=point.knots,
            steps=point.steps.on(point.grid) if len(point.steps) else point.steps,
            by_rows=point.by_rows,
            forms=self.signals.at(point.x),
            bent=self.signals.bent(point.x, rows),
            numbers=len(point.x),
            columns=self._wiring.columns,
            kinds=self._wiring.kinds,
            t_end=self.wanted.t_end,
            rtol=self.task.options.rtol,
        )

    def _refuse_stopped(self, status: int, detail: Detail) -> None:
        if status != DONE:
            component, time, value, column = detail
            why = told(self.task.system, status, component, time, value, column)
            raise NoGradient([f"the run stopped early: {why}"])


def _forward(rows: Array, events: Array, one: Functional) -> Array:
    """Derivatives from those of all rows and events."""
    return one.along(rows, events)


def _back(tape: Any, slopes: Slopes, shape: tuple[int, int], events: int, one: Functional) -> Array:
    """Derivatives by following a run back."""
    by_rows, by_events = np.zeros(shape), np.zeros(events)
    one.into(by_rows, by_events)
    found: Array = tape.back(by_rows, by_events) @ slopes.matrix + one.direct
    return found
