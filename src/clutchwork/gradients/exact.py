"""Values and derivatives by runs of the core that carry derivatives through every event."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError
from clutchwork.gradients.grazing import crowded, decided, noted, refused, struck_together, together
from clutchwork.gradients.measures import Asked, Measure, measures
from clutchwork.gradients.primal import Primal
from clutchwork.gradients.runs import Run, Runs
from clutchwork.gradients.task import Found, Task
from clutchwork.gradients.traces import at_events, at_knots, merged, traces_of
from clutchwork.results.gradient import NoGradient
from clutchwork.sweeps.outputs import AtTimes, Integral, Output

Array = NDArray[np.float64]

# variants of one call without derivatives
MOST_AT_ONCE = 256
# derivatives of equal extremes are one where they differ by less, of their size
ALIKE = 1e-6
# a run is followed back from so many numbers on, and from so many more for each result
FOLLOWED_FROM, FOLLOWED_FOR_EACH = 12, 4


@dataclass(frozen=True, eq=False)
class Exact:
    """Runs with derivatives."""

    task: Task

    @cached_property
    def runs(self) -> Runs:
        """The runs."""
        return Runs(self.task)

    @cached_property
    def _asked(self) -> Asked:
        wanted = self.runs.wanted
        kept = {one.name: wanted.kept_as(one) for one in wanted.outputs.values() if isinstance(one, Integral)}
        return Asked(wanted.contacts, kept, wanted.begin)

    def values(self, x: Array) -> Array:
        """Values for each line of numbers, NaN where there is none."""
        found = [self._values(x[first : first + MOST_AT_ONCE]) for first in range(0, len(x), MOST_AT_ONCE)]
        return np.concatenate(found) if found else np.zeros((0, len(self.task.labels)))

    def refuse_lines(self, x: Array) -> None:
        """ModelError, which names the line, where the driveline refuses numbers of a batch."""
        for number, line in enumerate(x):
            try:
                self.runs.words.at(line)
            except ModelError as error:
                raise ModelError(error.problems, f"x[{number}] of {len(x)} lines") from None

    def _values(self, x: Array) -> Array:
        systems = [self.runs.words.bytes_at(line) for line in x]
        return self.runs.plain.values(systems, [self.runs.signals.at(line) for line in x])

    def gradient(self, x: Array) -> Found:
        """Values and derivatives at a point; NoGradient names all that do not exist."""
        labels, outputs = self.task.labels, self.task.outputs
        if self._is_followed_back(x, len(labels)):
            run, found = self._run(x, len(labels))
            return self._found(run, *self._measured(x, run, labels, found))
        run = self.runs.forward(self.runs.point(x))
        # of signals at instants all rows at once
        single = {name: one for name, one in outputs.items() if not isinstance(one, AtTimes)}
        found = measures(run.primal, single, self._asked)
        _refuse(list(self._problems(x, run, list(single), found, outputs.values())))
        return self._found(run, *merged(run, outputs, self._measured(x, run, list(single), found)))

    def _measured(self, x: Array, run: Run, names: Sequence[str], found: Sequence[Measure]) -> tuple[Array, Array]:
        """Values and derivatives of measures."""
        lines = [np.array([run.slope(one) for one in measure.changes]) for measure in found]
        problems = list[str]()
        for name, one, own in zip(names, found, lines, strict=True):
            problems += _several(name, one, own, self._sizes(x))
        _refuse(problems)
        matrix = np.array([own[0] for own in lines]).reshape(len(found), len(x))
        return np.array([one.value for one in found]), matrix

    def _found(self, run: Run, values: Array, matrix: Array) -> Found:
        return Found(values, matrix, self._notes(run))

    def _notes(self, run: Run) -> tuple[str, ...]:
        found = [*run.notes, *noted(self.task.system, run.primal.grazes, run.primal.events)]
        return tuple(dict.fromkeys(found))

    def gradients(self, x: Array) -> tuple[Array, Array]:
        """The same for each line of numbers; NaN where there is none."""
        with ThreadPoolExecutor(self.task.threads) as pool:
            found = list(pool.map(self._gradient_or_none, x))
        shape = (len(x), len(self.task.labels), len(self.task.parameters))
        return np.array([one.values for one in found]).reshape(shape[:2]), np.array(
            [one.matrix for one in found]
        ).reshape(shape)

    def _gradient_or_none(self, x: Array) -> Found:
        try:
            return self.gradient(x)
        except NoGradient:
            return Found(self._values(x[None])[0], np.full((len(self.task.labels), len(x)), np.nan))

    def product(self, x: Array, weights: Array) -> tuple[Array, Array]:
        """Values at a point, and the derivatives of their weighted sum."""
        run, found = self._run(x, 1)
        whole = run.primal.functional()
        for share, one in zip(weights.tolist(), found, strict=True):
            whole.include(one.changes[0], share)
        return np.array([one.value for one in found]), run.slope(whole)

    def _run(self, x: Array, results: int) -> tuple[Run, list[Measure]]:
        """A run and what is measured in it: followed back where results are few and numbers many."""
        point = self.runs.point(x)
        run = self.runs.taped(point) if self._is_followed_back(x, results) else self.runs.forward(point)
        if not run.is_forward and together(run.primal.grazes):
            run = self.runs.forward(point)
        found = measures(run.primal, self.task.outputs, self._asked)
        _refuse(list(self._problems(x, run, self.task.labels, found)))
        return run, found

    @staticmethod
    def _is_followed_back(x: Array, results: int) -> bool:
        """Whether following a run back costs less than carrying derivatives along."""
        return len(x) >= FOLLOWED_FROM + FOLLOWED_FOR_EACH * results

    # ------------------------------------------------------------------------------------------------------- what fails

    def _sizes(self, x: Array) -> Array:
        own = [one.scale if one.places or not v else 0.0 for one, v in zip(self.task.parameters, x, strict=True)]
        return np.maximum(np.abs(x), own)

    def _problems(
        self, x: Array, run: Run, names: Sequence[str], found: Sequence[Measure], outputs: Iterable[Output] = ()
    ) -> Iterator[str]:
        """Why there is no derivative of measures, nor of those of outputs that are signals at instants."""
        for name, one in zip(names, found, strict=True):
            if not one.changes:
                yield f"{name} does not happen before {run.primal.t_end:g} s; take one that does, or a later end time"
            elif one.at is not None:
                yield from _at_event(name, one.at, run)
                yield from _at_knot(name, one, run.primal)
            for time in one.kinks:
                yield f"{name} has a kink at {time:.9g} s, where knots meet or the run begins or ends; move a knot"
        asked = traces_of(outputs)
        yield from (_moving(name, time) for name, time in at_events(run, asked))
        yield from (_at_moving_knot(name, time) for name, time in at_knots(run, asked))
        until = [*(one.until for one in found), *(one.times[-1] for one in asked)]
        yield from self._not_there(x, run, max(until, default=0.0))

    def _not_there(self, x: Array, run: Run, until: float) -> Iterator[str]:
        """Why there is no derivative of anything up to a time [s]."""
        primal, sizes = run.primal, float(np.max(self._sizes(x), initial=0.0))
        yield from refused(self.task.system, decided(primal.grazes, primal.events), until, sizes)
        yield from crowded(primal.events, self.runs.wanted.contacts, until)
        yield from struck_together(self.task.system, primal.events, self.runs.wanted.contacts, until)


def _refuse(problems: list[str]) -> None:
    if problems:
        raise NoGradient(list(dict.fromkeys(problems)))


def _at_event(name: str, time: float, run: Run) -> Iterator[str]:
    """An instant that is asked for and is that of an event, which moves."""
    there = np.abs(run.primal.events[:, 0] - time) <= 1e-12 * (1.0 + abs(time))
    for number in np.flatnonzero(there).tolist():
        moves = run.primal.functional()
        moves.add_event(number, 1.0)
        if np.any(run.slope(moves)):
            yield _moving(name, time)


def _moving(name: str, time: float) -> str:
    return f"{name} is asked for at the instant of an event, {time:.9g} s, which moves; ask before or behind it"


def _at_knot(name: str, one: Measure, primal: Primal) -> Iterator[str]:
    """An instant that is asked for and is that of a knot that moves, where the value bends or jumps with it."""
    time = float(one.at or 0.0)
    if any(primal.bends_at(columns, np.array([time]))[0] for columns in one.changes[0].columns):
        yield _at_moving_knot(name, time)


def _at_moving_knot(name: str, time: float) -> str:
    return f"{name} is asked for at a knot that moves, {time:.9g} s; ask before or behind it"


def _several(name: str, one: Measure, lines: Array, sizes: Array) -> Iterator[str]:
    """Equal extremes whose derivatives differ.

    Parameters: sizes, by which numbers are compared.
    """
    allowed = ALIKE * (np.abs(lines).max(axis=0, initial=0.0) + one.size / sizes)
    for line, when in zip(lines[1:], one.when[1:], strict=False):
        if np.any(np.abs(line - lines[0]) > allowed):
            remedy = "move a number so that one of them is the only one"
            yield f"{name} is reached at {one.when[0]:.9g} s and at {when:.9g} s, and they move apart; {remedy}"
            return
