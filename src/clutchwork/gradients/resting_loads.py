"""Loads that follow the motion and rest at zero, as those of weights at their onset: a little more of them acts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.memoize import memoize
from clutchwork.declare.node import is_reference
from clutchwork.declare.schema import inputs
from clutchwork.gradients.references import TakenOff, taken_off
from clutchwork.gradients.watched import Distance, distance, moved
from clutchwork.model.parts import is_stop

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.run_point import Run, RunPoint

Mask = NDArray[np.bool_]


class Follower(NamedTuple):
    """A contact whose load follows speeds or states."""

    contact: int
    name: str
    shared: int  # the shared state that presses it, -1 of none
    taken: TakenOff | None  # what is taken off that


def resting_loads(system: System, point: RunPoint, run: Run) -> Iterator[tuple[str, Mask]]:
    """What is said of loads that rest at zero, and numbers that would make some."""
    for one in followers(system):
        load = _load(one, system, point, run)
        found = [(time, moved(point, run, load, time)) for time in point.looked_at]
        at = [time for time, numbers in found if numbers.any()]
        if at:
            why = f"the load of {one.name} rests at zero up to {at[-1]:.9g} s, where a little more of it acts"
            yield f"{why} and a little less does not", np.logical_or.reduce([numbers for _, numbers in found])


def _load(one: Follower, system: System, point: RunPoint, run: Run) -> Distance:
    """What stands for a load: a load of zero and one below it have the same capacity, states tell them apart."""
    columns = run.primal.columns
    if one.shared < 0:
        return distance([columns["contact_capacity"].start + one.contact], [1.0])
    column = columns["state"].stop - int(system.counts["shared"]) + one.shared
    scale, first = float(system.arrays["shared_scale"][one.shared]), point.chart.words_in("params")[0]
    taken = [] if one.taken is None else [one.taken]
    return distance([column], [scale], [first + own.place for own in taken], [own.sign for own in taken])


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
