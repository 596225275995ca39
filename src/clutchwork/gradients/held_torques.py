"""Torques of contacts that break away: right before it they are their capacity, which is known better.

The torque of a stiff contact rises far faster than its capacity changes. docs/theory/gradients.md (12)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.declare.layout import CAUSES, EVENT
from clutchwork.gradients.primal import EVENT as AT_EVENT
from clutchwork.gradients.primal import SAME, Primal
from clutchwork.results.forms import LOCKED

Places = NDArray[np.intp]

AT = {name: column for column, (name, _) in enumerate(EVENT)}
LIMIT = next(number for number, (name, _) in CAUSES.items() if name == "torque limit")
# a torque and its capacity that differ by less are one, of the capacity
ALIKE = 1e-6


class HeldTorque(NamedTuple):
    """The torque of a contact at its limit: a column of a row that holds its capacity, and the sign."""

    column: Places
    sign: float


def torque_at_limit(primal: Primal, signal: str, step: int) -> HeldTorque | None:
    """Where a signal at the end of a step is the torque of a contact that breaks away there; None where it is not."""
    kind, number = (int(found[step + 1]) for found in primal.between)
    parts = primal.columns["contact_torque"]
    if kind != AT_EVENT or signal in primal.bent:
        return None
    known = primal.forms[signal].weights(primal.rows[:1])
    column = int(known.columns[0]) if len(known.columns) == 1 else -1
    if not parts.start <= column < parts.stop:
        return None
    events, contact = primal.events, column - parts.start
    time = events[number, AT["time"]]
    there = np.abs(events[:, AT["time"]] - time) <= SAME * (1.0 + abs(time))
    there &= (events[:, AT["contact"]] == contact) & (events[:, AT["from"]] == LOCKED)
    if not np.any(there & (events[:, AT["cause"]] == LIMIT)):
        return None
    rows, own = primal.steps.rows[step], primal.columns["contact_capacity"].start + contact
    torque, capacity = (float(primal.steps.right[step] @ primal.rows[rows, place]) for place in (column, own))
    if not abs(abs(torque) - capacity) <= ALIKE * capacity:
        return None
    return HeldTorque(np.array([own]), float(np.sign(torque) * known.values[0, 0]))
