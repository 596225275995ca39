"""Requested values of a run and how they change: one measure for each number of each output."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.declare.layout import EVENT
from clutchwork.gradients import extremes, jerk
from clutchwork.gradients.bent_slips import Shares, resting, turning
from clutchwork.gradients.functional import Functional
from clutchwork.gradients.primal import Primal
from clutchwork.gradients.signals import add_signal, signal_at
from clutchwork.results.forms import LOCKED
from clutchwork.sweeps.outputs import (
    PER_WINDOW,
    AtEnd,
    AtTimes,
    Extreme,
    FeltJerk,
    Integral,
    Output,
    SquaredJerk,
    When,
)

Array = NDArray[np.float64]
Places = NDArray[np.intp]

# an extreme in short steps is another one where it is so much more, of the size of the signal
SHORT = 1e-6
# of the time of the run: an extreme is where bristles turn
NEAR = 1e-4
# by so much of a squared jerk bristles that turn may move it
BENT = 1e-5
# places of the speeds that a second difference is made of
WINDOWS = np.array([0, PER_WINDOW, 2 * PER_WINDOW])
AT = {name: column for column, (name, _) in enumerate(EVENT)}


class Measure(NamedTuple):
    """A value of a run: NaN where there is none, how it changes, and up to when it looks."""

    value: float
    changes: tuple[Functional, ...]  # more than one where there are equal extremes
    until: float  # s
    when: tuple[float, ...] = ()  # s, where the extremes are
    at: float | None = None  # s, an instant that is asked for
    compares: tuple[float, ...] = ()  # s, instants whose speeds it compares
    kinks: tuple[float, ...] = ()  # s, where knots meet that it depends on
    size: float = 0.0  # of the signal whose extreme it is
    is_least: bool = False  # a minimum, which of equal ones is the one that falls most
    missed: tuple[tuple[Functional, float], ...] = ()  # what moves, and by how much its share in the value is not known
    is_massless: bool = False  # of a shaft whose accelerations are not known well
    unseen: float = 0.0  # share of a squared jerk that is not in the rows of the steps
    is_unseen: bool = False  # an extreme that is not in them
    lost: float | None = None  # s, where it jumps without an event, and nothing says how that instant moves
    is_held: bool = False  # the lock-up of a contact that is locked all the while
    feels_start: bool = False  # whether it has a share of accelerations and torques at the very start
    is_sum: bool = False  # a squared jerk, which has a share of all that settles
    is_bent: bool = False  # whether it looks at a step in which bristles turn, as no event does


class Context(NamedTuple):
    """What outputs need to know of a System."""

    contacts: tuple[str, ...]
    kept_as: Mapping[str, str]  # integrals by name -> signal
    begin: float  # s
    massless: frozenset[str] = frozenset()  # accelerations of shafts without inertia
    bristles: tuple[Shares, ...] = ()  # slips of contacts whose laws have them
    powers: tuple[Shares, ...] = ()  # of those whose laws have a power of the slip, which no polynomial follows
    # of the value: what may be missed of a derivative, for a number that changes by all of itself
    unknown: float = 1e-6


def measures(primal: Primal, one: Output, asked: Context) -> Iterator[Measure]:
    """All of an output, in order."""
    match one:
        case AtEnd(signal):
            yield _at(primal, signal, primal.t_end)
        case AtTimes(signal, times):
            yield from (_at(primal, signal, time) for time in times)
        case Integral():
            yield _change(primal, asked.kept_as[one.name], asked.begin)
        case When():
            yield _when(primal, one, asked)
        case Extreme():
            yield _extreme(primal, one, asked)
        case FeltJerk():
            yield _felt(primal, one, asked.begin)
        case SquaredJerk():
            yield _jerk(primal, one, asked)


def _at(primal: Primal, signal: str, time: float) -> Measure:
    into, row = primal.functional(), np.array([primal.row(time)])
    add_signal(primal, signal, row, np.ones(1), into)
    starts = bool(row[0] == 0)
    return Measure(float(signal_at(primal, signal, row)[0]), (into,), time, at=time, feels_start=starts)


def _change(primal: Primal, signal: str, begin: float) -> Measure:
    into, rows = primal.functional(), np.array([primal.row(begin), primal.row(primal.t_end)])
    add_signal(primal, signal, rows, np.array([-1.0, 1.0]), into)
    first, last = signal_at(primal, signal, rows)
    # it ends as what is asked for at the end does
    return Measure(float(last - first), (into,), primal.t_end, at=primal.t_end)


def number_of(events: Array, one: When, contacts: tuple[str, ...]) -> int:
    """The event that is asked for, by its number among all; -1 where it does not happen."""
    mine = events[:, AT["contact"]] == contacts.index(one.contact)
    was, became = events[:, AT["from"]] == LOCKED, events[:, AT["to"]] == LOCKED
    found = np.flatnonzero(mine & (became & ~was if one.kind == "lock" else was & ~became))
    found = found[np.argsort(events[found, AT["time"]], kind="stable")]
    place = one.number - 1 if one.number > 0 else len(found) + one.number
    return int(found[place]) if 0 <= place < len(found) else -1


def _when(primal: Primal, one: When, asked: Context) -> Measure:
    number = number_of(primal.events, one, asked.contacts)
    if number < 0:
        return Measure(float("nan"), (), primal.t_end, is_held=_is_held(primal, one, asked.contacts.index(one.contact)))
    into = primal.functional()
    into.add_event(number, 1.0)
    time = float(primal.events[number, AT["time"]])
    # whether one comes before it shows up to the end where they are counted from there
    return Measure(time, (into,), time if one.number > 0 else primal.t_end)


def _is_held(primal: Primal, one: When, contact: int) -> bool:
    """Whether it asks when a contact locks that never changes and is locked at the end."""
    modes = primal.rows[:, primal.columns["contact_mode"].start + contact]
    changes = np.any(primal.events[:, AT["contact"]] == contact)
    return one.kind == "lock" and not changes and bool(np.all(modes[-1:] == LOCKED))


def _is_near(primal: Primal, when: tuple[float, ...], turning: Places) -> bool:
    """Whether bristles turn about when an extreme is: many short steps may lie in between."""
    steps, room = primal.steps, NEAR * (primal.t_end - float(primal.times[0]))
    apart = np.maximum(steps.begin[turning] - np.array(when)[:, None], np.array(when)[:, None] - steps.end[turning])
    return bool(np.any(apart <= room))


def _extreme(primal: Primal, one: Extreme, asked: Context) -> Measure:
    steps, values = primal.steps, signal_at(primal, one.signal, primal.steps.rows)
    found = extremes.apart(primal, extremes.candidates(one, steps, values))
    changes = [primal.functional() for _ in found]
    missed = [extremes.add_extreme(primal, one, *both) for both in zip(found, changes, strict=True)]
    when, located = tuple(place.time(steps) for place in found), extremes.value(one, found)
    bent = turning(primal, asked.bristles) | resting(primal, asked.powers)
    whole, size = extremes.further(one, located, primal.by_rows[one]), float(np.abs(values).max(initial=0.0))
    return Measure(
        value=whole,
        changes=tuple(changes),
        until=max(when, default=primal.t_end),
        when=when,
        kinks=extremes.kinks(primal, found),
        size=size,
        is_least=one.kind == "minimum",
        missed=tuple(chain.from_iterable(missed)),
        feels_start=min(when, default=primal.t_end) <= primal.times[0],
        lost=next((place.time(steps) for place in found if extremes.is_lost(primal, one, place)), None),
        is_bent=_is_near(primal, when, np.flatnonzero(bent)),
        is_unseen=bool(np.isfinite(whole)) and not abs(whole - located) <= SHORT * size,
    )


def _felt(primal: Primal, one: FeltJerk, begin: float) -> Measure:
    """The largest of the second differences of a speed, docs/theory/jerk.md (1)."""
    times = one.times(begin, primal.t_end)
    if len(times) <= 2 * PER_WINDOW:
        return Measure(float("nan"), (), primal.t_end)
    rows = np.searchsorted(primal.times, times)
    jerks = one.felt(signal_at(primal, one.signal, rows))
    places, changes = _largest(np.abs(jerks)), list[Functional]()
    for place in places.tolist():
        changes.append(primal.functional())
        weights = np.sign(jerks[place]) / one.window**2 * np.array([1.0, -2.0, 1.0])
        add_signal(primal, one.signal, rows[place + WINDOWS], weights, changes[-1])
    when, compared = times[places + PER_WINDOW], np.unique(times[places[:, None] + WINDOWS])
    return Measure(
        value=float(np.abs(jerks).max()),
        changes=tuple(changes),
        until=float(compared[-1]),
        when=tuple(when.tolist()),
        compares=tuple(compared.tolist()),
    )


def _largest(sizes: Array) -> Places:
    """Places of the largest number and those that are as large; of neighbours, as on a plateau, both ends."""
    equal = sizes >= (1.0 - extremes.EQUAL) * sizes.max()
    inside = np.r_[False, equal[:-1]] & np.r_[equal[1:], False]
    found = np.flatnonzero(equal & ~inside)
    return found[: extremes.MOST_EQUAL]


def _jerk(primal: Primal, one: SquaredJerk, asked: Context) -> Measure:
    into, acceleration = primal.functional(), signal_at(primal, one.signal, primal.steps.rows)
    jerk.add_jerk(primal, one.signal, acceleration, into)
    is_massless, value = one.signal in asked.massless, primal.by_rows[one]
    bends = jerk.bends_in(primal.steps, acceleration, np.flatnonzero(turning(primal, asked.bristles)))
    return Measure(
        value=value,
        changes=(into,),
        until=primal.t_end,
        kinks=jerk.kinks(primal, acceleration),
        missed=tuple(jerk.missed(primal, one.signal, acceleration, is_massless=is_massless)),
        is_massless=is_massless,
        unseen=abs(value - jerk.seen(primal.steps, acceleration)) / max(value, 1e-291),
        feels_start=True,
        is_sum=True,
        is_bent=bends > BENT * value,
    )
