"""Loads that follow the motion and rest at zero, as those of weights at their onset: a little more of them acts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.memoize import memoize
from clutchwork.declare.node import is_reference
from clutchwork.declare.schema import inputs
from clutchwork.gradients.knots import times_of
from clutchwork.gradients.references import Place, taken_off
from clutchwork.model.parts import is_stop

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.runs import Run, RunPoint
    from clutchwork.gradients.words import Chart

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# so near to zero a load rests there, of what numbers change it by, and of the relative tolerance of the run
NEAR, BY_TOLERANCE = 1e-9, 1.0
# at so many knots it is looked at
MOST_KNOTS = 64


class Follower(NamedTuple):
    """A contact whose load follows speeds or states."""

    contact: int
    name: str
    shared: int  # the shared state that presses it, -1 of none
    taken: Place | None  # what is taken off that


def instants(system: System, chart: Chart, words: Array, begin: float, end: float) -> tuple[float, ...]:
    """When loads that follow the motion are looked at [s]: at knots, up to which they may rest, and at the end."""
    if not followers(system):
        return ()
    return (*[time for time in times_of(chart, words, end) if begin < time < end][:MOST_KNOTS], end)


def resting_loads(system: System, point: RunPoint, run: Run) -> Iterator[tuple[str, Mask]]:
    """What is said of loads that rest at zero, and numbers that would make some."""
    times = point.looked_at
    for one in followers(system):
        moved = [(time, _moved(one, system, point, run, time)) for time in times]
        at = [time for time, numbers in moved if numbers.any()]
        if at:
            why = f"the load of {one.name} rests at zero up to {at[-1]:.9g} s, where a little more of it acts"
            yield f"{why} and a little less does not", np.logical_or.reduce([numbers for _, numbers in moved])


def _moved(one: Follower, system: System, point: RunPoint, run: Run, time: float) -> Mask:
    """Numbers that move a load which is zero at an instant."""
    primal, taken = run.primal, np.zeros(len(point.x))
    states, value, scale = primal.columns["state"], 0.0, 1.0
    # a load of zero and one below it have the same capacity, states tell them apart
    column = primal.columns["contact_capacity"].start + one.contact
    if one.shared >= 0:
        column = states.stop - int(system.counts["shared"]) + one.shared
        scale = float(system.arrays["shared_scale"][one.shared])
    if one.taken is not None:
        word = point.chart.words_in("params")[0] + one.taken.place
        value = one.taken.sign * float(point.words[word])
        taken = one.taken.sign * point.slopes.of(np.array([word]))[0]
    own = scale * primal.rows[:, column] - value
    here, allowed = abs(float(own[primal.row(time)])), max(NEAR, BY_TOLERANCE * primal.rtol)
    moves = primal.functional()
    moves.add(np.array([primal.row(time)]), np.array([column]), np.array([[scale]]))
    # what dies away has derivatives that do so too
    changes = np.abs(run.slope(moves) - taken) * point.sizes if here <= allowed * max(_most(own), 1.0) else 0.0 * taken
    found: Mask = (changes > NEAR * _most(own)) & (here <= allowed * changes)
    return found


def _most(values: Array) -> float:
    return float(np.abs(values).max(initial=0.0))


@memoize
def followers(system: System) -> tuple[Follower, ...]:
    """Contacts whose load follows speeds or states."""
    shared = {link.name: link.number for link in system.links if link.sort == "shared"}
    taken = {one.name.partition(".")[0]: one for one in taken_off(system)}
    found = list[Follower]()
    for number, contact in enumerate(system.contacts):
        for names, spec in inputs(type(contact)) if not is_stop(contact) else ():
            name = next((name for name in names if is_reference(getattr(contact, name, None))), "")
            if name and (spec.presses or spec.gain or name == "speed"):
                state = shared.get(f"{contact.name}.{name}", -1)
                found.append(Follower(number, contact.name, state, taken.get(contact.name) if state >= 0 else None))
    return tuple(found)
