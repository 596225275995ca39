"""A brake or clutch at full pressure that slips nevertheless."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from clutchwork.hints.hint import Hint, more_than, shown
from clutchwork.hints.look import Look
from clutchwork.hints.registry import run_rule
from clutchwork.hints.rules.never_locks import never_locks
from clutchwork.hints.slipping import FullSlip, full_slips, pressed

NAME = "full and slips"
# a load that is less than this above the torque is a balance, such as of a car that is held back downhill
PULLED = 1.05
# growth of the slip, over what it grows to, that is more than a swing
GROWTH = 0.1


@run_rule(NAME)
def full_and_slips(look: Look) -> Iterator[Hint]:
    """An actuated brake or clutch whose slip grows although it is at its largest load."""
    told = {name for hint in never_locks(look) for name in hint.elements}
    for contact, branch in pressed(look):
        if branch.name in told or not look.actuated(contact):
            continue
        found = [slip for slip in full_slips(look, contact, branch) if _pulled(slip)]
        if found:
            yield _hint(max(found, key=lambda slip: slip.heat), len(found))


def _pulled(slip: FullSlip) -> bool:
    return slip.after - slip.before > GROWTH * slip.after and PULLED * slip.kinetic < slip.needed < np.inf


def _hint(slip: FullSlip, times: int) -> Hint:
    torque, speed = slip.torque_unit, slip.speed_unit
    more = f"; {times} such phases, this one the hottest" if times > 1 else ""
    message = (
        f"is fully applied from {slip.begin:.4g} to {slip.end:.4g} s and slips, from {shown(slip.before, speed)} up to"
        f" {shown(slip.after, speed)}: it would have to hold {shown(slip.needed, torque)}, transmits"
        f" {shown(slip.kinetic, torque)} while it slips and breaks away at {shown(slip.capacity, torque)}; it makes"
        f" {shown(slip.heat, 'J')} of heat{more}"
    )
    factor = more_than(slip.needed / slip.kinetic)
    remedy = f"give it more than {factor} times the load, gain or coefficient, or less to hold"
    numbers = {
        f"needed [{torque}]": slip.needed,
        f"slipping torque [{torque}]": slip.kinetic,
        f"capacity [{torque}]": slip.capacity,
        f"slip [{speed}]": slip.after,
        "heat [J]": slip.heat,
    }
    return Hint(NAME, (slip.branch.name,), message, remedy, numbers, slip.begin, slip.end)
