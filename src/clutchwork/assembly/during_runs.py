"""What may change while a run goes on, and why the rest stays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from clutchwork.base.memoize import memoize
from clutchwork.declare.core import core
from clutchwork.declare.node import Component, Work

if TYPE_CHECKING:
    from clutchwork.assembly.system_data import SystemData


class Stays(NamedTuple):
    """Why something stays as it is while a run goes on, and what to do instead."""

    why: str
    remedy: str


NEW_RUN = "give it to the model, and start a new run"
OTHER = Stays("changes the structure of the driveline", "build another driveline for it")
INERTIA = Stays("is an inertia: changing it would create kinetic energy", NEW_RUN)
SIGNAL = Stays("is part of a signal", "set the signal itself to a number")
# by the first words of the name of an array
STAYS = {
    "inertia": INERTIA,
    "mass": INERTIA,
    "basis": Stays("is a rigid ratio: changing it would make speeds jump", "build another driveline for it"),
    "initial": Stays("is an initial value, and the run has started", NEW_RUN),
    "shared": Stays("is part of the heat that a thermal node holds: changing it would create heat", NEW_RUN),
    "heat": Stays("says where heat goes, which is fixed during a run", NEW_RUN),
    "points": Stays("is a table, which is fixed during a run", NEW_RUN),
    "segment": SIGNAL,
    "input": SIGNAL,
    "contact_law": Stays("is another friction law, with states of its own", NEW_RUN),
    "contact": Stays("says when a contact may lock, which is fixed during a run", NEW_RUN),
}
STORES = Stays("determines the energy that the element stores: changing it would create energy", NEW_RUN)
VARIANT = Stays("selects a variant, which is fixed during a run", NEW_RUN)
NOTHING = Stays("has no effect during a run", NEW_RUN)


def numbers(present: SystemData, new: SystemData) -> dict[int, float]:
    """Parameters of the core that differ, by their places."""
    before, after = present.arrays["params"], new.arrays["params"]
    if before.shape != after.shape:
        return {}
    return {int(place): float(after[place]) for place in np.flatnonzero(before != after)}


def stays(base: SystemData, present: SystemData, new: SystemData) -> Stays | None:
    """Why a run cannot go on as another System; None where it can.

    Parameters: base, the System of the run; present, with what was changed so far; new, with all changes.
    """
    for array, old in present.arrays.items():
        other = new.arrays[array]
        if array == "params" or other is old:
            continue
        if old.shape != other.shape or old.tobytes() != other.tobytes():
            return next((why for word, why in STAYS.items() if array.startswith(word)), OTHER)
    if present.arrays["params"].shape != new.arrays["params"].shape:
        return OTHER
    if any(map(_stores_otherwise, present.elements, new.elements)):
        return STORES
    known = numbers(present, new).items()
    return None if all(_scratch(base).is_settable(*one) for one in known) else VARIANT


@memoize
def _scratch(system: SystemData) -> Any:
    """A run of the core that is asked which numbers it takes."""
    return core().Run(system.to_bytes())


def _stores_otherwise(before: Component, after: Component) -> bool:
    """Whether an element with other numbers stores another energy in the same state."""
    if Work.STORE not in before.work or before is after:
        return False
    states = [1.0] * len(before.states)
    return before.stored(states, 1.0) != after.stored(states, 1.0)
