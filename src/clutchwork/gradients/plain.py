"""Values alone, of many points at once: runs without derivatives, by the door of sweeps."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.declare.core import core
from clutchwork.declare.layout import DONE
from clutchwork.gradients import extremes
from clutchwork.gradients.measures import number_of
from clutchwork.gradients.refined import Seen, WithinSteps, refined
from clutchwork.gradients.resolved import SHARP, STILL_SHARP, around_tops, resolved
from clutchwork.gradients.steps import NO_STEPS, Steps
from clutchwork.results.forms import all_reads
from clutchwork.sweeps.batch import CoreOutputs
from clutchwork.sweeps.outputs import AtEnd, AtTimes, Extreme, FeltJerk, Integral, SquaredJerk, When
from clutchwork.sweeps.parts import PARTS, squared_jerk

if TYPE_CHECKING:
    from clutchwork.results.forms import Form
    from clutchwork.sweeps.outputs import Output

Array = NDArray[np.float64]

IN_STEPS = (Extreme, SquaredJerk)
NO_VALUES, FIRST = np.zeros(0), np.zeros(1, dtype=np.intp)


# component, time, value, column
Detail = tuple[int, float, float, int]
NO_DETAIL: Detail = (-1, 0.0, 0.0, -1)


class Run(NamedTuple):
    """What the core gave for one point."""

    status: int
    detail: Detail  # of one that stopped early
    grid: Array  # rows at the instants
    times: Array  # instants of rows in steps
    rows: Array
    events: Array  # as layout.EVENT, without what is not asked for


@dataclass(frozen=True, eq=False)
class PlainRuns:
    """Runs without derivatives, and outputs of them."""

    wanted: CoreOutputs
    options: Mapping[str, float]
    threads: int
    inside: WithinSteps | None = None  # what may bend or jump inside of steps

    def runs(self, systems: Sequence[bytes], columns: Sequence[int], *, grid: bool, steps: bool) -> list[Run]:
        """One run for each of the bytes; numbers of a row that are kept, at the instants and in the steps."""
        on_grid = self._call(systems, columns, 0) if grid else None
        in_steps = self._call(systems, columns, PARTS) if steps else None
        first: Any = on_grid or in_steps
        status, detail = first[0], first[1]
        rows = on_grid[2] if on_grid else np.zeros((len(systems), 0, len(columns)))
        parts = _by_variant(in_steps[3], len(systems), len(columns)) if in_steps else [_nothing(columns)] * len(systems)
        events = _events(first[3], len(systems))
        return [
            Run(int(status[n]), _detail(status[n], detail[n]), rows[n], *parts[n], events[n])
            for n in range(len(systems))
        ]

    def rows_at(self, system: bytes, columns: Sequence[int], times: Array, t_end: float | None = None) -> Array:
        """Numbers of the rows of one run at instants.

        Parameters: t_end, of a run that is not to go on to its end [s].
        """
        found: Array = self._call([system], columns, 0, times, t_end)[2][0]
        return found

    def with_steps(self, system: bytes, forms: Mapping[str, Form]) -> tuple[Run, Steps, dict[Output, float]]:
        """One run, its steps as one with derivatives looks into them, and jerks and extremes in short steps by rows.

        They end where signals of extremes bend or jump, which the rows at the very ends of its own steps see.
        """
        ones = [one for one in self.wanted.outputs.values() if isinstance(one, IN_STEPS)]
        seen = self.inside.columns if self.inside is not None else ()
        columns, own = over_columns([{one.signal: forms[one.signal] for one in ones}], seen)
        run = self.runs([system], columns, grid=False, steps=True)[0]
        steps = Steps.of_parts(run.times)
        whole = split = steps.covering()
        if run.status == DONE:
            places, rows_at = [columns.index(one) for one in seen], partial(self.rows_at, system, columns)
            known, rows = _rows_of(whole, steps.long(), run.rows, rows_at)
            split, rows = self.refined(known, rows, own[0], places, rows_at)
            accelerations = [own[0][one.signal](rows) for one in ones if isinstance(one, SquaredJerk)]
            split = resolved(split, [np.asarray(one, dtype=float)[split.rows] for one in accelerations])
            split = whole if split is known else split
        by_rows: dict[Output, float] = {one: _by_rows(one, run, steps, own[0][one.signal]) for one in ones}
        return run, whole.inside() if split is whole else split, by_rows

    def _call(
        self,
        systems: Sequence[bytes],
        columns: Sequence[int],
        parts: int,
        instants: Array | None = None,
        t_end: float | None = None,
    ) -> Any:
        count = len(systems)
        choice = np.arange(count, dtype=np.int64).reshape(-1, 1)
        times = np.zeros(0) if parts else self.wanted.grid if instants is None else instants
        threads, end = min(self.threads, max(1, count // 2)), self.wanted.t_end if t_end is None else t_end
        options, kept = list(self.options.items()), np.array(columns, dtype=np.int64)
        found = core().sweep(list(systems), [], choice, options, end, times, parts, kept, True, threads, None)
        if found[4] is not None:
            raise found[4]
        return found

    # ---------------------------------------------------------------------------------------------------------- outputs

    @cached_property
    def in_steps(self) -> bool:
        """Whether any output is looked for within the steps."""
        return any(isinstance(one, IN_STEPS) for one in self.wanted.outputs.values())

    @cached_property
    def on_grid(self) -> bool:
        """Whether any output is read at instants."""
        return bool(self.wanted.signals(AtEnd, AtTimes, FeltJerk, Integral)) or not self.in_steps

    def values(self, systems: Sequence[bytes], forms: Sequence[Mapping[str, Form]]) -> Array:
        """Outputs of each of the bytes, with the forms of its signals; NaN for what there is not."""
        seen = self.inside.columns if self.inside is not None else ()
        columns, own = over_columns(forms, seen)
        runs = self.runs(systems, columns, grid=self.on_grid, steps=self.in_steps)
        places = [columns.index(one) for one in seen]
        return np.array(
            [
                self._of(run, some, places, partial(self.rows_at, system, columns))
                for system, run, some in zip(systems, runs, own, strict=True)
            ]
        )

    def refined(
        self,
        steps: Steps,
        rows: Array,
        forms: Mapping[str, Form],
        seen: Sequence[int],
        rows_at: Callable[[Array], Array],
    ) -> tuple[Steps, Array]:
        """Steps and their rows, split where signals of extremes bend or jump inside of them, and around their tops.

        Parameters: seen, where in a row the columns of `inside` are; rows_at, rows of the same run at any instants.
        """
        ones = [one for one in self.wanted.outputs.values() if isinstance(one, Extreme)]
        if not ones or not len(steps):
            return steps, rows

        def on(made: Steps) -> tuple[Steps, Array]:
            grid = np.unique(made.times)
            return made.on(grid), rows_at(grid)

        def values(made: Steps, known: Array) -> list[Array]:
            return [np.asarray(forms[one.signal](known), dtype=float)[made.rows] for one in ones]

        def at_bends(inside: WithinSteps, made: Steps) -> Seen:
            placed, known = (steps, rows) if made is steps else on(made)
            return inside.seen(ones, values(placed, known), known[:, seen], placed.rows)

        split = None if self.inside is None else refined(steps, ones, partial(at_bends, self.inside))
        found = (steps, rows) if split is None else on(split)
        for sharp in (SHARP, STILL_SHARP, STILL_SHARP):
            made = around_tops(found[0], list(zip(ones, values(*found), strict=True)), sharp)
            if made is found[0]:
                break
            found = on(made)
        return found

    def _of(
        self, run: Run, forms: Mapping[str, Form], seen: Sequence[int], rows_at: Callable[[Array], Array]
    ) -> list[float]:
        found = list[float]()
        steps = Steps.of_parts(run.times) if self.in_steps else NO_STEPS
        reached = run.status == DONE
        looks = reached and bool(self.wanted.signals(Extreme))
        split = self.refined(steps.long(), run.rows, forms, seen, rows_at) if looks else (steps, run.rows)
        for one in self.wanted.outputs.values():
            if isinstance(one, When):
                number = number_of(run.events, one, self.wanted.contacts)
                found.append(float(run.events[number, 0]) if number >= 0 else np.nan)
            elif isinstance(one, Extreme):
                short = _by_rows(one, run, steps, forms[one.signal]) if reached else np.nan
                found.append(extremes.further(one, _extreme(one, *split, forms), short) if reached else np.nan)
            elif isinstance(one, SquaredJerk):
                found.append(_jerk(run, steps, forms[one.signal]) if reached else np.nan)
            else:
                found += self._on_grid(one, run.grid, forms, reached)
        return found

    def _on_grid(self, one: Any, grid: Array, forms: Mapping[str, Form], reached: bool) -> list[float]:
        values = np.asarray(forms[self.wanted.kept_as(one)](np.nan_to_num(grid)), dtype=float)
        if isinstance(one, AtTimes):
            rows = np.searchsorted(self.wanted.grid, one.times)
            there = ~np.isnan(grid[rows]).all(axis=1) if grid.shape[1] else np.full(len(rows), reached)
            return [float(value) for value in np.where(there, values[rows], np.nan)]
        if not reached:
            return [float("nan")]
        if isinstance(one, FeltJerk):
            return [float(one.largest(values[np.searchsorted(self.wanted.grid, self.wanted.felt(one))]))]
        return [float(values[-1] - values[0] if isinstance(one, Integral) else values[-1])]


def over_columns(
    forms: Sequence[Mapping[str, Form]], more: Sequence[int] = ()
) -> tuple[list[int], list[dict[str, Form]]]:
    """Numbers of a row that signals need, and more, and their forms over these alone."""
    columns = sorted({*all_reads(form for some in forms for form in some.values()), *more})
    places = {column: place for place, column in enumerate(columns)}
    return columns, [{name: form.over(places) for name, form in some.items()} for some in forms]


def _rows_of(whole: Steps, own: Steps, rows: Array, rows_at: Callable[[Array], Array]) -> tuple[Steps, Array]:
    """Steps with their rows; those that cover short ones beside them have others than their own."""
    if np.array_equal(whole.length, own.length):
        return whole, rows
    made = whole.inside()
    grid = np.unique(made.times)
    return made.on(grid), rows_at(grid)


def _by_rows(one: Extreme | SquaredJerk, run: Run, steps: Steps, form: Form) -> float:
    """A squared jerk, or an extreme in steps that are too short for runs with derivatives; NaN without any."""
    if isinstance(one, SquaredJerk):
        return _jerk(run, steps, form)
    short = np.ones(len(run.rows), dtype=bool)
    short[steps.rows[steps.is_long]] = False
    values = np.asarray(form(run.rows[short]), dtype=float) if short.any() else NO_VALUES
    return float(one.reduced(values, FIRST)[0]) if len(values) else float("nan")


def _jerk(run: Run, steps: Steps, form: Form) -> float:
    return squared_jerk(run.times, np.asarray(form(run.rows), dtype=float), steps.rows[:, 0])


def _extreme(one: Extreme, steps: Steps, rows: Array, forms: Mapping[str, Form]) -> float:
    values = np.asarray(forms[one.signal](rows), dtype=float)[steps.rows]
    return extremes.value(one, extremes.candidates(one, steps, values))


def _nothing(columns: Sequence[int]) -> tuple[Array, Array]:
    return np.zeros(0), np.zeros((0, len(columns)))


def _by_variant(parts: Any, count: int, width: int) -> list[tuple[Array, Array]]:
    """Times and rows of each variant, from what each thread has."""
    found = [(np.zeros(0), np.zeros((0, width)))] * count
    for variants, counts, times, rows, *_ in parts:
        ends = np.cumsum(counts)
        for variant, begin, end in zip(variants.tolist(), (ends - counts).tolist(), ends.tolist(), strict=True):
            found[variant] = times[begin:end], rows[begin:end]
    return found


def _events(parts: Any, count: int) -> list[Array]:
    """Events of each variant: time, contact, modes."""
    known = np.concatenate([np.zeros((0, 5)), *(part[4] for part in parts)])
    return [known[known[:, 0] == number][:, 1:] for number in range(count)]


def _detail(status: int, numbers: Array) -> Detail:
    if status == DONE:
        return NO_DETAIL
    component, time, value, column = np.nan_to_num(numbers, nan=-1.0).tolist()
    return int(component), time, value, int(column)
