"""Torques of contacts that break away, or begin to share a load otherwise: right before it they are their capacity.

The torque of a stiff contact rises far faster than its capacity changes, which is known better.
docs/theory/gradients.md (12)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.declare.layout import CAUSES, EVENT
from clutchwork.gradients.functional import Functional
from clutchwork.gradients.instants import add_shift
from clutchwork.gradients.primal import EVENT as AT_EVENT
from clutchwork.gradients.primal import SAME, SMOOTH, Primal
from clutchwork.results.forms import LOCKED

Places = NDArray[np.intp]

AT = {name: column for column, (name, _) in enumerate(EVENT)}
LIMIT = next(number for number, (name, _) in CAUSES.items() if name == "torque limit")
# a torque and its capacity that differ by less are one, of the capacity
ALIKE = 1e-6


class HeldTorque(NamedTuple):
    """The torque of a contact at its limit: columns of a row that hold its capacity and itself, and their signs."""

    column: Places
    sign: float
    torque: Places
    weight: float


def torque_at_limit(primal: Primal, signal: str, step: int) -> HeldTorque | None:
    """Where a signal at the end of a step is the torque of a contact at its limit there; None where it is not."""
    parts = primal.columns["contact_torque"]
    if signal in primal.bent:
        return None
    known = primal.forms[signal].weights(primal.rows[:1])
    column = int(known.columns[0]) if len(known.columns) == 1 else -1
    if not parts.start <= column < parts.stop:
        return None
    contact = column - parts.start
    if not (is_torn(primal, step + 1) or _breaks_away(primal, contact, step + 1)):
        return None
    rows, own = primal.steps.rows[step], primal.columns["contact_capacity"].start + contact
    torque, capacity = (float(primal.steps.right[step] @ primal.rows[rows, place]) for place in (column, own))
    if not abs(abs(torque) - capacity) <= ALIKE * capacity:
        return None
    weight = float(known.values[0, 0])
    return HeldTorque(np.array([own]), float(np.sign(torque) * weight), known.columns, weight)


def is_torn(primal: Primal, step: int) -> bool:
    """Whether a signal jumps where a step begins, at no event and no knot."""
    return bool(0 < step < len(primal.steps) and primal.steps.torn[step] and primal.between[0][step] == SMOOTH)


def _breaks_away(primal: Primal, contact: int, step: int) -> bool:
    """Whether a contact breaks away at its limit where a step begins."""
    kind, number = (int(found[step]) for found in primal.between)
    if kind != AT_EVENT:
        return False
    events, time = primal.events, primal.events[number, AT["time"]]
    there = np.abs(events[:, AT["time"]] - time) <= SAME * (1.0 + abs(time))
    there &= (events[:, AT["contact"]] == contact) & (events[:, AT["from"]] == LOCKED)
    return bool(np.any(there & (events[:, AT["cause"]] == LIMIT)))


def add_held(primal: Primal, held: HeldTorque, step: int, share: float, into: Functional) -> None:
    """Add a share of the derivative of a torque that is at its limit at the end of a step."""
    steps, rows = primal.steps, primal.steps.rows[step]
    rate = held.sign * float(steps.right_slope[step] @ primal.rows[rows, held.column[0]])
    into.add(rows, held.column, share * held.sign * steps.right[step][:, None])
    if not is_torn(primal, step + 1):
        add_shift(primal, step + 1, share * rate, into)
        return
    # the instant is where the torque meets its capacity
    rise = held.weight * float(steps.right_slope[step] @ primal.rows[rows, held.torque[0]]) - rate
    moved = share * rate / rise if rise else 0.0
    into.add(rows, held.column, moved * held.sign * steps.right[step][:, None])
    into.add(rows, held.torque, -moved * held.weight * steps.right[step][:, None])
