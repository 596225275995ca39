"""Where derivatives hardly exist: guards that are hardly passed, and events at one instant.

docs/theory/gradients.md (6)
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import HOUSING, wiring
from clutchwork.base.memoize import memoize
from clutchwork.declare.core import derivatives
from clutchwork.declare.layout import CAUSES, EVENT
from clutchwork.results.forms import LOCKED

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[np.float64]

# time derivative of a guard over its size [1/s]: below the first it is said, below the second it is refused
WARNED, REFUSED = 0.1, 0.01
# by so much the derivatives of two events at one instant may differ, of the time that a number takes to be all of it
APART = 1e-9
# events that are as close are at one instant [s]
ONE_INSTANT = 1e-9
# times of a guard and of its event that differ by less are one, of a second or of their size
SAME = 1e-12
TIME, KIND, COMPONENT, INDEX, DIFFERENCE = range(5)
# how slowly a piece of a law or a process is entered that is said [1/s]
TOUCHED = 1e-5
# so many changes within so long [s] are refused
CROWD, CROWDED = 6, 1e-4
BY_NAME = {name: number for number, (name, _) in CAUSES.items()}
PIECES = ("line", "law")
BORDERS = (*PIECES, "process", "flip")
# at these something may stay, though nothing moves with them
STAYS = ("multiplier", "set", "bend")
# kind of a jump of a torque that no guard sees
UNSEEN = 1000
ASK = "; ask for one side of it"
IMPACT, JAM, DRIVEN = BY_NAME["impact"], BY_NAME["jam"], (BY_NAME["input"], BY_NAME["other event"])
PAIR = 2
# slips that are multiples of each other, but for the round-off of their rates
ALIKE = 1e-12
# causes of events that are decided together with others
TAKEN_ALONG = (IMPACT, BY_NAME["other event"])
AT = {name: column for column, (name, _) in enumerate(EVENT)}


@cache
def guards(effect: str) -> tuple[int, ...]:
    """Numbers in the core of the guards with an effect: "decides" about contacts, or takes to the "next piece"."""
    return tuple(number for number, (_, found) in enumerate(derivatives().guards) if found == effect)


@cache
def borders() -> tuple[int, ...]:
    """Numbers in the core of the guards where another piece of a law, a table or a process begins."""
    return tuple(number for number, (name, _) in enumerate(derivatives().guards) if name in BORDERS)


@cache
def pieces() -> tuple[int, ...]:
    """Numbers in the core of the guards where another piece of a law or a table begins, over what moves alone."""
    return tuple(number for number, (name, _) in enumerate(derivatives().guards) if name in PIECES)


@cache
def loads() -> tuple[int, ...]:
    """Numbers in the core of the guards of loads that follow torques."""
    return tuple(number for number, (name, _) in enumerate(derivatives().guards) if name == "flip")


@cache
def contact_loads() -> tuple[int, ...]:
    """Numbers in the core of the guards of loads that press contacts."""
    return tuple(number for number, (name, _) in enumerate(derivatives().guards) if name == "load")


@cache
def limits() -> tuple[int, ...]:
    """Numbers in the core of the guards of what locked contacts hold."""
    return tuple(number for number, (name, _) in enumerate(derivatives().guards) if name in ("multiplier", "set"))


@cache
def sets() -> tuple[int, ...]:
    """Numbers in the core of the guards of contacts that hold together."""
    return tuple(number for number, (name, _) in enumerate(derivatives().guards) if name == "set")


@cache
def _staying() -> tuple[int, ...]:
    return tuple(number for number, (name, _) in enumerate(derivatives().guards) if name in STAYS)


def _on_borders(grazes: Array) -> NDArray[np.bool_]:
    """Those at which another piece begins, or which something stays at: a point of a table, a load of zero."""
    stays = np.isin(grazes[:, KIND], _staying()) & np.isinf(grazes[:, INDEX])
    found: NDArray[np.bool_] = np.isin(grazes[:, KIND], borders()) | stays
    return found


def together(grazes: Array, decided: Array) -> bool:
    """Whether what is hit at one instant moves apart, of which a run that is followed back knows no more.

    Parameters: decided, those of the grazes that did.
    """
    if not grazes[:, DIFFERENCE].any():
        return False
    bordering = grazes[_on_borders(grazes) | (grazes[:, KIND] < 0)]
    return bool(np.any(bordering[:, DIFFERENCE] > 0.0) or np.any(decided[:, DIFFERENCE] > 0.0))


def decided(grazes: Array, events: Array) -> Array:
    """Those that made a contact stick, slip, close, open or jam, of those that hardly did or met others.

    What passes from one piece of a law or a table to the next, and what bounces, may do so slowly: the motion goes on
    as it was, or jumps by less the slower it is.
    """
    deciders = guards("decides")
    known = [
        number
        for number, graze in enumerate(grazes.tolist())
        if (graze[INDEX] < WARNED or graze[DIFFERENCE]) and graze[KIND] in deciders
    ]
    if not known:
        return grazes[:0]
    is_change = (events[:, AT["from"]] != events[:, AT["to"]]) | (events[:, AT["cause"]] == JAM)
    changed, deciding = events[is_change, AT["time"]], grazes.take(known, axis=0)
    there = np.abs(deciding[:, TIME, None] - changed) <= SAME * (1.0 + np.abs(changed))
    found: Array = deciding[there.any(axis=1)]
    return found


def refused(system: System, decided: Array) -> Iterator[tuple[float, str]]:
    """Why derivatives from some instants [s] on may not exist: what decided only just touched zero."""
    for graze in decided.tolist():
        if not graze[INDEX] < REFUSED:
            continue
        time, name = graze[TIME], component(system, int(graze[COMPONENT]), int(graze[KIND]))
        measure = f"abs(dg/dt)/scale = {graze[INDEX]:.2g} 1/s, below {REFUSED:g} 1/s"
        remedy = "move a number so that it passes clearly, or not at all"
        why = "only just touches zero, so the time of this event has no derivative"
        yield time, f"{name} at {time:.9g} s {why}: {measure}; {remedy}"


def moving_apart(
    system: System, grazes: Array, decided: Array, begin: float, sizes: Array
) -> Iterator[tuple[float, str]]:
    """What is hit at one instant [s] but not beside it: by the order other pieces and modes may follow.

    Parameters: decided, those of the grazes that did; begin, of the run [s], where one is enough; sizes of the numbers,
    by the largest of which derivatives of instants become times.
    """
    if not any(graze[DIFFERENCE] for graze in grazes.tolist()):
        return
    met = np.concatenate([decided, grazes[_on_borders(grazes)]])
    for graze in np.unique(met[met[:, DIFFERENCE] * sizes.max() > APART], axis=0):
        time, name = float(graze[TIME]), component(system, int(graze[COMPONENT]), int(graze[KIND]))
        if graze[KIND] in loads() and graze[INDEX] == np.inf:
            yield time, f"the load of {name} is zero from {time:.9g} s on, and a little more turns it either way{ASK}"
        elif graze[KIND] in limits() and graze[INDEX] == np.inf and graze[COMPONENT] >= 0:
            what = f"{name} is closed without load, or holds all that it can, from {time:.9g} s on"
            yield time, f"{what}, and a little change lets it go{ASK}"
        elif abs(time - begin) <= SAME * (1.0 + abs(begin)):
            yield time, f"{name} begins where it goes from one piece to another; move a start value, or that border"
        elif graze[INDEX] == np.inf:
            what = (
                f"{name} stays at a border of its table or its law from {time:.9g} s on, and numbers move that border"
            )
            yield time, f"{what}{ASK}"
        else:
            what = f"two events at {time:.9g} s, of which {name} is one, move apart with the numbers; separate them"
            yield time, what


def begins_unloaded(system: System, grazes: Array, sizes: Array) -> Iterator[str]:
    """Contacts whose load follows the motion and begins at zero: what is asked of the start itself has two sides.

    Parameters: sizes of the numbers.
    """
    for graze in grazes.tolist():
        if graze[KIND] in contact_loads() and graze[INDEX] == np.inf and graze[DIFFERENCE] * sizes.max() > APART:
            name = component(system, int(graze[COMPONENT]), int(graze[KIND]))
            yield f"{name} begins where its load begins or ends; move a start value, or what makes that load"


def jumping_together(system: System, grazes: Array, sizes: Array) -> Iterator[tuple[float, str]]:
    """Signals that jump at one instant, and whose knots move apart: which of them jumps first is open.

    Parameters: sizes of the numbers.
    """
    for graze in grazes.tolist():
        if graze[KIND] >= 0 or graze[DIFFERENCE] * sizes.max() <= APART:
            continue
        time, name = float(graze[TIME]), component(system, int(graze[COMPONENT]), int(graze[KIND]))
        yield time, f"{name} jumps at {time:.9g} s together with another signal, whose knot moves otherwise; move one"


def crowded(events: Array, contacts: Sequence[str]) -> Iterator[tuple[float, str]]:
    """Contacts that lock and break away repeatedly within an instant, where no derivative exists."""
    if len(events) < CROWD:
        return
    changed = events[(events[:, AT["from"]] == LOCKED) != (events[:, AT["to"]] == LOCKED)]
    for number, name in enumerate(contacts) if len(changed) >= CROWD else ():
        times = np.sort(changed[changed[:, AT["contact"]] == number, AT["time"]])
        close = np.flatnonzero(times[CROWD - 1 :] - times[: max(0, len(times) - CROWD + 1)] < CROWDED)
        if len(close):
            first, last = float(times[close[0]]), float(times[close[0] + CROWD - 1])
            why = f"locks and breaks away {CROWD} times within {CROWDED:g} s at {first:.9g} s"
            yield last, f"{name} {why}; give the parts beside it damping, or its law more static friction"


def struck_together(system: System, events: Array, contacts: Sequence[str]) -> Iterator[tuple[float, str]]:
    """Stops that are struck at one instant, of which one bounces: the order of the blows decides.

    Those on shafts that share no motion do not feel each other.
    """
    if events[:, AT["cause"]].tolist().count(IMPACT) < 2:
        return
    hit = events[events[:, AT["cause"]] == IMPACT]
    parts = moving_together(system)[hit[:, AT["contact"]].astype(int)]
    for part in np.unique(parts):
        yield from _struck(hit[parts == part], contacts)


def _struck(hit: Array, contacts: Sequence[str]) -> Iterator[tuple[float, str]]:
    times, bounces = hit[:, AT["time"]], hit[:, AT["to"]] != LOCKED
    close = (np.diff(times) <= ONE_INSTANT * 1e-3) & (np.diff(hit[:, AT["contact"]]) != 0.0)
    for place in np.flatnonzero(close & (bounces[1:] | bounces[:-1])):
        names = " and ".join(contacts[int(number)] for number in hit[place : place + 2, AT["contact"]])
        time = float(times[place])
        yield time, f"{names} are struck at one instant, {time:.9g} s, and bounce; give them different gaps"
        return


def arriving_together(
    system: System, events: Array, begin: float, contacts: Sequence[str]
) -> Iterator[tuple[float, str]]:
    """Contacts that come to rest, or are struck, at one instant, each for itself: they move with numbers of their own.

    An impact decides about all contacts, and so does a slip that ends: what is known of the instant is that of one.
    Parameters: begin, of the run [s], which does not move.
    """
    if len(events) < PAIR or np.diff(events[:, AT["time"]]).min() > ONE_INSTANT * 1e-3:
        return
    struck = events[:, AT["cause"]] == IMPACT
    lands = (events[:, AT["to"]] == LOCKED) & (events[:, AT["from"]] != LOCKED)
    later = events[:, AT["time"]] > begin
    known = events[(struck | lands) & later & (events[:, AT["contact"]] >= 0.0)]
    for place in np.flatnonzero(np.diff(known[:, AT["time"]]) <= ONE_INSTANT * 1e-3).tolist():
        pair = known[place : place + 2]
        first, second = pair[:, AT["contact"]].astype(int).tolist()
        if np.isin(pair[:, AT["cause"]], TAKEN_ALONG).any() and not _slip_alike(system, first, second):
            one, other = contacts[first], contacts[second]
            time = float(pair[0, AT["time"]])
            yield time, f"{one} and {other} come to rest, or are struck, at one instant, {time:.9g} s; separate them"
            return


def _slip_alike(system: System, one: int, other: int) -> bool:
    """Whether the slip of a contact is a multiple of that of another: both end at one instant whatever is moved."""
    arrays = system.arrays
    ends, rows = arrays["contact_rate_end"], np.zeros((2, len(arrays["initial_speed"])))
    for row, number in zip(rows, (one, other), strict=True):
        own = slice(int(ends[number - 1]) if number else 0, int(ends[number]))
        row[arrays["contact_rate_column"][own]] = arrays["contact_rate_value"][own]
    sizes = np.linalg.norm(rows, axis=1)
    return bool(abs(rows[0] @ rows[1]) >= (1.0 - ALIKE) * sizes[0] * sizes[1])


def decided_at_knots(
    events: Array, grazes: Array, knots: Sequence[float], contacts: Sequence[str]
) -> Iterator[tuple[float, str]]:
    """Contacts that lock or break away where a signal bends: whether the knot or the event comes first is undecided.

    Parameters: knots, instants of all in order [s]. Where a signal jumps the knot is what makes them do so.
    """
    for event in events.tolist():
        time = event[AT["time"]]
        if (event[AT["from"]] == LOCKED) == (event[AT["to"]] == LOCKED) or not _is_near(time, knots):
            continue
        if event[AT["cause"]] in DRIVEN and _is_near(time, sorted(grazes[grazes[:, KIND] < 0, TIME].tolist())):
            continue
        what = "locks" if event[AT["to"]] == LOCKED else "breaks away"
        yield time, f"{contacts[int(event[AT['contact']])]} {what} at {time:.9g} s, where a signal bends; move the knot"


def _is_near(time: float, others: Sequence[float]) -> bool:
    """Whether an instant is among others, which are in order."""
    room = ONE_INSTANT * (1.0 + abs(time))
    place = bisect_left(others, time - room)
    return place < len(others) and others[place] <= time + room


@memoize
def moving_together(system: System) -> NDArray[np.int64]:
    """For each contact the part of the driveline that it is in: shafts that elements, contacts or gears join."""
    known = wiring(system)
    joined = [set(one.direction) for one in (*known.elements, *known.contacts, *known.motions)]
    joined += [{node for node, _ in row.ports.values()} for row in known.gears]
    part = np.arange(len(known.nodes) + 1)
    for nodes in joined:
        moving = [node for node in nodes if node != HOUSING]
        # all that any of them is joined to already
        part[np.isin(part, part[moving])] = min(part[moving], default=0)
    places = [[node for node in one.direction if node != HOUSING][:1] for one in known.contacts]
    return np.array([int(part[own[0]]) if own else -1 for own in places], dtype=np.int64)


def noted(system: System, grazes: Array, decided: Array) -> Iterator[str]:
    """What is only just differentiable.

    Parameters: decided, those of the grazes that are.
    """
    for graze in grazes.tolist():
        if not graze[INDEX] < TOUCHED or graze[KIND] not in guards("next piece"):
            continue
        name = component(system, int(graze[COMPONENT]), int(graze[KIND]))
        measure = f"abs(dg/dt)/scale = {graze[INDEX]:.2g} 1/s, below {TOUCHED:g} 1/s"
        yield f"{name} at {graze[TIME]:.9g} s hardly enters another piece: {measure}; derivatives have few digits"
    for graze in decided.tolist():
        if REFUSED <= graze[INDEX] < WARNED:
            name = component(system, int(graze[COMPONENT]), int(graze[KIND]))
            measure = f"abs(dg/dt)/scale = {graze[INDEX]:.2g} 1/s, below {WARNED:g} 1/s"
            yield f"{name} at {graze[TIME]:.9g} s barely passes zero: {measure}; derivatives are large and local"


def passed_unseen(system: System, grazes: Array) -> Iterator[tuple[float, str]]:
    """What happens that nothing is known of: from then on [s] there are no derivatives.

    Slips that have passed zero with which a torque jumps, where no event is; sets of contacts that let go, where what
    they hold does not show how that moves.
    """
    for time, kind, number, index, _ in grazes.tolist():
        if kind == UNSEEN:
            name = component(system, int(number), UNSEEN)
            what = f"the torque of {name} jumps with the sign of its slip at {time:.9g} s, where no event is"
            yield time, f"{what}; take a law that sticks, such as Stribeck, for derivatives"
        elif kind in sets() and index == 0.0:
            name = component(system, int(number), int(kind))
            what = f"{name} lets go at {time:.9g} s with others, and what they hold does not show how that moves"
            yield time, f"{what}; give one of them a capacity of its own"


def component(system: System, number: int, kind: int) -> str:
    """What an event belongs to: an element, a contact or a signal."""
    if kind < 0:
        return system.inputs[number].name if 0 <= number < len(system.inputs) else "a signal"
    known = wiring(system)
    parts = [*known.elements, *known.contacts]
    return parts[number].name if 0 <= number < len(parts) else "a process"
