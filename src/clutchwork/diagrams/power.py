"""Power that goes through the lines of a member, from what its sets, elements, input and output put in."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING

from clutchwork.gearbox.gear_set import HOUSING

if TYPE_CHECKING:
    from clutchwork.diagrams.shown import BoxAtWork
    from clutchwork.gearbox.definition import Definition

# who puts power into a member: a set and its port, an element, input or output
Source = tuple[str, str]
INPUT, OUTPUT = ("", "input"), ("", "output")


def sources(box: Definition, now: BoxAtWork) -> dict[str, dict[Source, float]]:
    """Power per power 1 at the input that each member takes up at each place; those of a member add up to zero."""
    found: dict[str, dict[Source, float]] = {member: {} for member in box.members}
    for one in box.sets:
        for port, power in now.set_powers[one.name].items():
            member = one.members[port]
            if member != HOUSING:
                found[member][one.name, port] = _known(power)
    for name in now.closed:
        element = box.element(name)
        torque = _known(now.torques[name])
        for member, sign in ((element.follower, 1.0), (element.base, -1.0)):
            if member != HOUSING:
                found[member][name, ""] = sign * torque * now.speeds[member]
    found[box.input][INPUT] = now.given
    found[box.output][OUTPUT] = -_known(now.taken)
    return found


def _known(value: float) -> float:
    """What elements share in more than one way counts as nothing."""
    return 0.0 if isnan(value) else value
