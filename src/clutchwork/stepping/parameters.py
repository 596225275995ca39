"""Parameters that may change while a run is stepped: what of a System differs then, and why the others stay."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base.errors import ModelError, Problem
from clutchwork.base.memoize import memoize
from clutchwork.declare.node import Component, Work
from clutchwork.run.begin import new_run

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

NEW_RUN = "give it to the model, and start a new run"
OTHER = ("changes what the driveline is made of", "build another driveline for it")
# by the first words of the name of an array: what a change would mean, and what to do instead
STAYS = {
    "inertia": ("is an inertia: to change it would make energy of the motion out of nothing", NEW_RUN),
    "mass": ("is an inertia: to change it would make energy of the motion out of nothing", NEW_RUN),
    "basis": ("is a rigid ratio: to change it would make speeds jump", "build another driveline for it"),
    "initial": ("is a value at the start of a run, which is over", NEW_RUN),
    "shared": ("is part of the heat that a thermal node holds: to change it would make heat out of nothing", NEW_RUN),
    "heat": ("says where heat goes, which stays so while a run goes on", NEW_RUN),
    "points": ("is a table, which stays as it is while a run goes on", NEW_RUN),
    "segment": ("is part of a signal", "set the signal itself to a number"),
    "input": ("is part of a signal", "set the signal itself to a number"),
    "contact_law": ("is another friction law, with states of its own", NEW_RUN),
    "contact": ("says when a contact may lock, which stays so while a run goes on", NEW_RUN),
}
STORES = "decides how much energy the element stores: to change it would make some out of nothing"
VARIANT = "selects a variant, which stays so while a run goes on"
NOTHING = "acts on nothing while a run goes on"


class Change:
    """What setting values of a model does to a run of the core."""

    def __init__(self, base: System, present: System, new: System) -> None:
        """Parameters: base, the System of the run; present, with what was changed so far; new, with all changes."""
        self.new = new
        self._base, self._present = base, present
        before, after = present.arrays["params"], new.arrays["params"]
        same = before.shape == after.shape
        self.params = {int(place): float(after[place]) for place in np.flatnonzero(before != after)} if same else {}

    def refusals(self) -> Iterator[tuple[str, str]]:
        """Why it cannot be done while a run goes on: what is wrong, and the remedy."""
        old, new = self._present.arrays, self.new.arrays
        for array in new:
            if array != "params" and (
                old[array].shape != new[array].shape or old[array].tobytes() != new[array].tobytes()
            ):
                yield next((why for word, why in STAYS.items() if array.startswith(word)), OTHER)
        if old["params"].shape != new["params"].shape:
            yield OTHER
        elif any(map(_stores_otherwise, self._present.elements, self.new.elements)):
            yield STORES, NEW_RUN
        elif not all(_scratch(self._base).is_settable(place, value) for place, value in self.params.items()):
            yield VARIANT, NEW_RUN


@memoize
def _scratch(system: System) -> Any:
    """A run of the core that is asked which numbers it takes."""
    return new_run(system.to_bytes())


def _stores_otherwise(before: Component, after: Component) -> bool:
    """Whether an element with other numbers stores another energy in the same state."""
    if Work.STORE not in before.work or before is after:
        return False
    states = [1.0] * len(before.states)
    return before.stored(states, 1.0) != after.stored(states, 1.0)


def changed(
    base: System, present: System, settled: Mapping[str, Any], given: Mapping[str, Any]
) -> tuple[Change | None, list[Problem]]:
    """What new values do to a run, or all that is wrong with them.

    Parameters: settled, what was changed before; given, the new values by name, None: that of the model again.
    """
    made, wrong, refused = _changed(base, present, settled, given)
    if made is None and len(given) > 1:
        # find the offending value; single values may fail although the combination is valid
        alone = [_changed(base, present, settled, {name: value})[2] for name, value in given.items()]
        refused = [problem for problems in alone for problem in problems] or refused
    return made, wrong + refused


def _changed(
    base: System, present: System, settled: Mapping[str, Any], given: Mapping[str, Any]
) -> tuple[Change | None, list[Problem], list[Problem]]:
    """What new values do, what is wrong with them in any model, and why a run that goes on refuses them."""
    wanted = {name: value for name, value in {**settled, **given}.items() if value is not None}
    try:
        made = Change(base, present, base.changed(wanted) if wanted else base)
    except ModelError as error:
        return None, list(error.problems), []
    why = next(made.refusals(), None)
    return (made, [], []) if why is None else (None, [], [Problem(", ".join(given), "", why[0], remedy=why[1])])
