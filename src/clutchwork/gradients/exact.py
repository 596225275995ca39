"""Derivatives by the core: a run that carries them through every event."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import wiring
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError
from clutchwork.declare.core import core
from clutchwork.declare.status import DONE
from clutchwork.gradients.chart import Slopes
from clutchwork.gradients.engine import Found, Task
from clutchwork.gradients.grazing import decided, noted, refused
from clutchwork.gradients.knots import knots
from clutchwork.gradients.measures import Asked, Measure, measures
from clutchwork.gradients.plain import Plain
from clutchwork.gradients.primal import Knots, Primal
from clutchwork.gradients.signals_at import SignalsAt
from clutchwork.gradients.steps import Steps
from clutchwork.gradients.words import Words
from clutchwork.results.gradient import NoGradient
from clutchwork.run.simulation import told
from clutchwork.sweeps.batch import Wanted
from clutchwork.sweeps.outputs import Integral
from clutchwork.sweeps.words import Layout

Array = NDArray[np.float64]

# variants of one call without derivatives
MOST_AT_ONCE = 256
# derivatives of equal extremes are one where they differ by less, of their size
ALIKE = 1e-6


class Tangents(NamedTuple):
    """What the core gives of a run with derivatives."""

    status: int
    filled: int
    rows: Array
    row_tangents: Array
    events: Array
    event_tangents: Array
    grazes: Array
    fault: tuple[int, float]


class Point(NamedTuple):
    """A point with what is known of its run before it is differentiated."""

    x: Array
    system: bytes
    slopes: Slopes
    knots: Knots
    steps: Steps
    grid: Array


@dataclass(frozen=True, eq=False)
class Exact:
    """Runs with derivatives."""

    task: Task

    @cached_property
    def _words(self) -> Words:
        return Words(self.task.system, tuple(self.task.parameters))

    @cached_property
    def _wanted(self) -> Wanted:
        task = self.task
        return Wanted.of(task.system, task.options, task.outputs, task.t_end)

    @cached_property
    def _signals(self) -> SignalsAt:
        return SignalsAt(self._words, self._wanted.all_signals)

    @cached_property
    def _options(self) -> dict[str, float]:
        # the one that runs with derivatives have
        return self.task.options.changed({"method": "rodas5p"}).core_options()

    @cached_property
    def _plain(self) -> Plain:
        return Plain(self._wanted, self._options, self.task.threads)

    # ----------------------------------------------------------------------------------------------------------- values

    def values(self, x: Array) -> Array:
        """Values for each line of numbers, NaN where there is none."""
        found = [self._values(x[first : first + MOST_AT_ONCE]) for first in range(0, len(x), MOST_AT_ONCE)]
        return np.concatenate(found) if found else np.zeros((0, len(self.task.outputs)))

    def _values(self, x: Array) -> Array:
        systems = [self._words.bytes_at(line) for line in x]
        return self._plain.values(systems, [self._signals.at(line) for line in x])

    # ------------------------------------------------------------------------------------------------------ derivatives

    def gradient(self, x: Array) -> Found:
        """Values and derivatives at a point."""
        point = self._point(x)
        made = self._tangents(point)
        primal = self._primal(point, made)
        found = measures(primal, self.task.outputs, self._asked)
        lines = [np.array([one.along(made.row_tangents, made.event_tangents) for one in m.changes]) for m in found]
        problems = [*self._problems(x, primal, found)]
        for name, one, own in zip(self._names, found, lines, strict=True):
            problems += _several(name, one, own, self._sizes(x))
        if problems:
            raise NoGradient(list(dict.fromkeys(problems)))
        matrix = np.array([own[0] for own in lines])
        notes = tuple(dict.fromkeys(noted(self.task.system, decided(primal.grazes, primal.events))))
        return Found(np.array([one.value for one in found]), matrix, notes)

    def gradients(self, x: Array) -> tuple[Array, Array]:
        """The same for each line of numbers; NaN where there is none."""
        with ThreadPoolExecutor(self.task.threads) as pool:
            found = list(pool.map(self._gradient_or_none, x))
        return np.array([one.values for one in found]), np.array([one.matrix for one in found])

    def _gradient_or_none(self, x: Array) -> Found:
        try:
            return self.gradient(x)
        except (NoGradient, ModelError):
            return Found(self._values(x[None])[0], np.full((len(self._names), len(x)), np.nan))

    def product(self, x: Array, weights: Array) -> tuple[Array, Array]:
        """Values at a point, and the derivatives of their weighted sum."""
        found = self.gradient(x)
        return found.values, weights @ found.matrix

    # ------------------------------------------------------------------------------------------------------------ a run

    def _point(self, x: Array) -> Point:
        chart, words = self._words.at(x)
        system, slopes = words.tobytes(), chart.slopes(x)
        wanted, steps = self._wanted, _no_steps()
        moving = knots(chart, words, slopes, wanted.begin, wanted.t_end)
        if self._plain.in_steps:
            run = self._plain.runs([system], [], grid=False, steps=True)[0]
            self._refuse_stopped(run.status, *run.detail)
            steps = Steps.of_parts(run.times).inside()
        return _with_grid(Point(x, system, slopes, moving, steps, wanted.grid), wanted.grid)

    def _tangents(self, point: Point) -> Tangents:
        found = self._run(point)
        self._refuse_stopped(found.status, found.fault[0], float("nan"), found.fault[1], -1)
        return found

    def _run(self, point: Point) -> Tangents:
        self._refuse_unknown(point)
        places, seeds = point.slopes.places.astype(np.int64), point.slopes.matrix
        options, size = list(self._options.items()), wiring(self.task.system).row_size
        return Tangents(*core().tangents(point.system, places, seeds, point.grid, self._wanted.t_end, options, size))

    def _refuse_unknown(self, point: Point) -> None:
        """Refuse points of curves, which have no derivatives in the core."""
        layout, size = Layout.of(self.task.system), self.task.system.arrays["points"].size
        first = layout.starts["points"] // 8
        inside = (point.slopes.places >= first) & (point.slopes.places < first + size)
        moved = np.flatnonzero(np.abs(point.slopes.matrix[inside]).sum(axis=0)).tolist()
        if moved:
            why = "moves points of a curve, which are not differentiated; compare runs: cw.sweep"
            raise NoGradient([f"{self.task.parameters[number].name} {why}" for number in moved])

    def _primal(self, point: Point, made: Tangents) -> Primal:
        columns = wiring(self.task.system).columns
        return Primal(
            times=point.grid,
            rows=made.rows,
            events=made.events,
            grazes=made.grazes,
            knots=point.knots,
            steps=point.steps.on(point.grid),
            forms=self._signals.at(point.x),
            bent=self._signals.bent(point.x, made.rows),
            numbers=len(point.x),
            speeds=columns["speed"],
            accelerations=columns["acceleration"],
            t_end=self._wanted.t_end,
        )

    @cached_property
    def _asked(self) -> Asked:
        wanted = self._wanted
        kept = {one.name: wanted.kept_as(one) for one in wanted.outputs.values() if isinstance(one, Integral)}
        return Asked(wanted.contacts, kept, wanted.begin)

    @property
    def _names(self) -> Sequence[str]:
        return self.task.labels

    # ------------------------------------------------------------------------------------------------------- what fails

    def _sizes(self, x: Array) -> Array:
        return np.maximum(
            np.abs(x),
            [one.scale if one.places or not v else 0.0 for one, v in zip(self.task.parameters, x, strict=True)],
        )

    def _refuse_stopped(self, status: int, component: int, time: float, value: float, column: int) -> None:
        if status != DONE:
            raise NoGradient(
                [f"the run stopped early: {told(self.task.system, status, component, time, value, column)}"]
            )

    def _problems(self, x: Array, primal: Primal, found: Sequence[Measure]) -> Iterator[str]:
        for name, one in zip(self._names, found, strict=True):
            if not one.changes:
                yield f"{name} does not happen before {primal.t_end:g} s; take one that does, or a later end time"
        until, scale = max((one.until for one in found), default=0.0), float(np.max(np.abs(x), initial=0.0))
        yield from refused(self.task.system, decided(primal.grazes, primal.events), until, scale)


def _several(name: str, one: Measure, lines: Array, sizes: Array) -> Iterator[str]:
    """Equal extremes whose derivatives differ.

    Parameters: sizes, by which numbers are compared.
    """
    allowed = ALIKE * (np.abs(lines).max(axis=0, initial=0.0) + abs(one.value) / sizes)
    for line, when in zip(lines[1:], one.when[1:], strict=False):
        if np.any(np.abs(line - lines[0]) > allowed):
            remedy = "move a number so that one of them is the only one"
            yield f"{name} is reached at {one.when[0]:.9g} s and at {when:.9g} s, and they move apart; {remedy}"
            return


def _no_steps() -> Steps:
    return Steps.of_parts(np.zeros(1))


def _with_grid(point: Point, asked: Array) -> Point:
    return point._replace(grid=np.unique(np.concatenate([asked, point.steps.times.ravel()])))
