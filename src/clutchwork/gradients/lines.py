"""Values of a run with their derivatives from both sides, one line for each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.measures import Context, Measure, measures
from clutchwork.gradients.primal import Primal
from clutchwork.gradients.run_point import Run
from clutchwork.gradients.traces import trace
from clutchwork.sweeps.outputs import AtEnd, AtTimes, Output

Array = NDArray[np.float64]
Places = NDArray[np.intp]

# derivatives of equal extremes are one where they differ by less, of their size
ALIKE = 1e-6
# what is not known of a derivative may be so much of the value, for a number that changes by all of itself
UNKNOWN = 1e-6
NOT_AGREED = (
    "follows an instant that moves, at which rates cancel, and runs of two tolerances do not agree on its derivatives; "
    "ask for another value, or give what settles there more inertia"
)
# share of a squared jerk in steps that runs with derivatives do not look into, from which on it has none
UNSEEN = 1e-5
UNSEEN_MOTION = "which has no derivatives; give what is so stiff more inertia, or start it where it has settled"
# a number that passes zero has at least this size, of the largest one of its kind
PASSES = 1e-3
# values below this are round-off
LEAST = 1e-18
NOWHERE, NONE = np.zeros(0, dtype=np.intp), np.zeros(0)


class Line(NamedTuple):
    """A value of a run, NaN where there is none, and its row of the Jacobian for growing and for falling numbers."""

    name: str
    value: float
    size: float  # of what it is one of, by which differences are judged
    left: Array
    right: Array
    until: float  # s, up to when it looks
    at: float | None = None  # s, an instant that is asked for
    columns: Places = NOWHERE  # of the rows that it is made of there
    kinks: tuple[float, ...] = ()  # s, where knots meet that it depends on
    none: str = ""  # why it has no derivative from any side
    several: str = ""  # why both sides differ
    rough: bool = False  # whether a run of a tighter tolerance knows its derivatives better
    missed: float = 0.0  # the most that is not known of one of them, of the value
    feels_start: bool = False  # whether it has a share of what is at the very start
    is_sum: bool = False  # whether it is a squared jerk
    is_bent: bool = False  # whether it looks at a bend that no event tells
    compares: tuple[float, ...] = ()  # s, instants whose speeds it compares
    is_open: bool = False  # whether runs of two tolerances do not agree on it, of a value that is rough at both

    def opened(self, numbers: NDArray[np.bool_]) -> Line:
        """The same where they do not agree on the derivatives by some numbers."""
        if not numbers.any():
            return self
        left, right = (np.where(numbers, np.nan, side) for side in (self.left, self.right))
        return self._replace(left=left, right=right, several=f"{self.name} {NOT_AGREED}", is_open=True)

    def refused(self, why: str) -> Line:
        """The same where it has none by the numbers that move it."""
        nothing = np.where((self.left == 0.0) & (self.right == 0.0), 0.0, np.nan)
        return self._replace(left=nothing, right=nothing, none=why, several="", rough=False)


def lines(run: Run, outputs: Mapping[str, Output], labels: Sequence[str], asked: Context, sizes: Array) -> list[Line]:
    """All that is asked for, in order; of signals at instants all rows at once where a run carries derivatives along.

    Parameters: sizes, of the numbers.
    """
    made, names = list[Line](), iter(labels)
    for one in outputs.values():
        if isinstance(one, (AtTimes, AtEnd)) and run.is_forward:
            columns, values, matrix = trace(run, one)
            times = one.times if isinstance(one, AtTimes) else (run.primal.t_end,)
            for time, value, own in zip(times, values, matrix, strict=True):
                size = _size(run.primal, columns, time)
                made.append(Line(next(names), float(value), size, own, own, time, time, columns))
        else:
            made += [
                _line(run, next(names), measure, sizes, asked.unknown) for measure in measures(run.primal, one, asked)
            ]
    return made


def without_derivatives(labels: Sequence[str], found: Sequence[Measure]) -> list[Line]:
    """Lines of measures for what asks for no derivatives: when they look, and where."""
    return [
        Line(name, one.value, one.size, NONE, NONE, one.until, one.at, _columns(one), one.kinks, compares=one.compares)
        for name, one in zip(labels, found, strict=True)
    ]


def _columns(one: Measure) -> Places:
    return np.concatenate([NOWHERE, *one.changes[0].columns]) if one.at is not None else NOWHERE


def _nothing(name: str, one: Measure, t_end: float) -> str:
    """Why a measure has no derivatives; none where it has."""
    if one.is_unseen:
        return f"{name} is reached in motion that settles within a few nanoseconds, {UNSEEN_MOTION}"
    if one.lost is not None:
        what = f"{name} is reached at {one.lost:.9g} s, where contacts that hold together share their load anew at once"
        return f"{what}, and nothing says how that instant moves; give one of them a law that yields"
    if one.is_held:
        return f"{name} does not happen: the contact is locked from the start to {t_end:g} s; let it slip at first"
    if not one.changes:
        return f"{name} does not happen before {t_end:g} s; take one that does, or a later end time"
    if one.unseen > UNSEEN:
        what = f"{min(100.0 * one.unseen, 100.0):.3g} % of {name} is from motion that settles within a few nanoseconds"
        return f"{what}, {UNSEEN_MOTION}"
    return ""


def _line(run: Run, name: str, one: Measure, sizes: Array, allowed: float) -> Line:
    found = np.array([run.slope(change) for change in one.changes])
    if none := _nothing(name, one, run.primal.t_end):
        # what moves nothing of it moves nothing that is not seen
        is_part = one.changes and not one.is_unseen and one.lost is None
        nothing = np.where(found[0] == 0.0, 0.0, np.nan) if is_part else np.full(len(sizes), np.nan)
        # a tighter run may see more
        rough = one.is_unseen or one.unseen > UNSEEN
        return Line(name, one.value, 0.0, nothing, nothing, one.until, none=none, rough=rough, missed=one.unseen)
    least = most = found[0]
    why, lost = "", unknown(run, one, sizes)
    apart = _apart(found, max(one.size, _of_its_kind(run.primal, one), LEAST) / sizes) if len(found) > 1 else NOWHERE
    if len(apart):
        remedy = "move a number so that one of them is the only one"
        first, second = (f"{one.when[place]:.9g} s" for place in (0, apart[0]))
        when = f"at {first} and at {second}" if first != second else f"right before {first} and right behind it"
        why = f"{name} is reached {when}, and they move apart; {remedy}"
        least, most = found.min(axis=0), found.max(axis=0)
    if one.is_massless and np.any(lost > UNKNOWN):
        least, most = (np.where(lost > UNKNOWN, np.nan, side) for side in (least, most))
        what = "a jerk that jumps at an instant that moves, of a shaft without inertia, whose acceleration is not known"
        why = why or f"{name} takes {what} well enough; give the shaft an inertia"
    left, right = (most, least) if one.is_least else (least, most)
    columns = _columns(one)
    size = max(one.size, LEAST) if one.at is None else _size(run.primal, columns, one.at)
    rough = bool(why) or bool(np.any(lost > allowed))
    most_missed = max(float(lost.max(initial=0.0)), run.primal.rtol if one.is_bent else 0.0)
    made = Line(name, one.value, size, left, right, one.until, one.at, columns, one.kinks, "", why, rough, most_missed)
    made = made._replace(feels_start=one.feels_start, compares=one.compares)
    return made._replace(is_sum=one.is_sum, is_bent=one.is_bent)


def unknown(run: Run, one: Measure, sizes: Array) -> Array:
    """How much is not known of the derivatives, of the value, for numbers that change by all of themselves."""
    lost: Array
    if not run.is_forward and len(one.missed) > 1:
        # entry and exit of a gap may move against each other: with equal signs, and with every other one turned
        sums = run.primal.functional(), run.primal.functional()
        for number, (moves, amount) in enumerate(one.missed):
            sums[0].include(moves, amount)
            sums[1].include(moves, -amount if number % 2 else amount)
        lost = np.maximum(*(np.abs(run.slope(whole)) for whole in sums))
    else:
        lost = sum((amount * np.abs(run.slope(moves)) for moves, amount in one.missed), start=np.zeros(len(sizes)))
    return lost * sizes / max(abs(one.value), one.size, LEAST)


def _size(primal: Primal, columns: Places, time: float) -> float:
    """That of some numbers of a row, with a share of the largest one of their kind there: they may pass zero."""
    row, own = primal.rows[primal.row(time)].tolist(), columns.tolist()
    used = {primal.kinds[column] for column in own}
    largest = max((abs(number) for part in used for number in row[primal.columns[part]]), default=0.0)
    return max(max((abs(row[column]) for column in own), default=0.0), PASSES * largest)


def _of_its_kind(primal: Primal, one: Measure) -> float:
    """A share of the largest number of the kinds that it is made of in a run: it may be round-off, a slip at rest."""
    own = np.unique(np.concatenate([NOWHERE, *one.changes[0].columns]))
    kinds = [part for part in primal.columns.values() if np.any((own >= part.start) & (own < part.stop))]
    return PASSES * max((float(np.abs(primal.rows[:, part]).max(initial=0.0)) for part in kinds), default=0.0)


def _apart(found: Array, sizes: Array) -> Places:
    """Equal extremes whose derivatives are not those of the first one."""
    allowed = ALIKE * (np.abs(found).max(axis=0, initial=0.0) + sizes)
    return np.flatnonzero(np.any(np.abs(found - found[0]) > allowed, axis=1))
