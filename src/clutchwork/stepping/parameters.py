"""Parameters that change while a run is stepped."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from clutchwork.assembly.during_runs import numbers, stays
from clutchwork.base.errors import ModelError, Problem

if TYPE_CHECKING:
    from clutchwork.assembly.system import System


class Change(NamedTuple):
    """What setting values of a model does to a run of the core: numbers by their places."""

    new: System  # with all changes
    params: dict[int, float]


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
        new = base.changed(wanted) if wanted else base
    except ModelError as error:
        return None, list(error.problems), []
    found = stays(base, present, new)
    if found is not None:
        return None, [], [Problem(", ".join(given), "", found.why, remedy=found.remedy)]
    return Change(new, numbers(present, new)), [], []
