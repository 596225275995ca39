"""A clutch that never locks although it is as full as it gets."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

import numpy as np

from clutchwork.assembly.wiring import HOUSING
from clutchwork.hints.hint import Hint, more_than, shown
from clutchwork.hints.look import Look
from clutchwork.hints.registry import run_rule
from clutchwork.hints.slipping import FullSlip, full_slips, pressed

NAME = "never locks"
# torque that keeps a slip over that of the clutch, from which it grows; what is equal settles, as on a bench
GROWS = 1.02
# share of the slip that was left where a clutch was let go shortly before it locked
NEAREST = 0.2


@run_rule(NAME)
def never_locks(look: Look) -> Iterator[Hint]:
    """A clutch between two shafts that never locks: at full pressure to the end, or released shortly before locking."""
    for contact, branch in pressed(look):
        if HOUSING in branch.direction or np.any(look.locked[:, contact]):
            continue
        if any(event.after == "locked" for event in look.events.of(branch.name)):
            continue
        found = list(full_slips(look, contact, branch))
        last = max(found, key=lambda slip: slip.end, default=None)
        if last is None:
            continue
        # where its slip is prescribed no torque can change it
        if last.end == look.end and GROWS * last.kinetic <= last.needed < inf:
            yield _too_weak(look, last)
        elif last.end < look.end and last.after < NEAREST * last.before:
            yield _let_go(last)


def _too_weak(look: Look, slip: FullSlip) -> Hint:
    torque, speed, name = slip.torque_unit, slip.speed_unit, slip.branch.name
    nearest = min(slip.before, float(np.min(np.abs(look.slip[slip.span.first + 1 :, slip.contact]))))
    # one that passes zero without a stop has no lowest slip
    lowest = f" and never below {shown(nearest, speed)}" if nearest > 0.0 else ""
    message = (
        f"is fully applied from {slip.begin:.4g} s to the end and never locks: it transmits"
        f" {shown(slip.kinetic, torque)} while it slips, but takes {shown(slip.needed, torque)} to keep its slip from"
        f" growing; the slip is {shown(slip.after, speed)} at {slip.end:.4g} s{lowest}"
    )
    factor = more_than(slip.needed / slip.kinetic)
    remedy = f"give it more than {factor} times the pressure, gain or coefficient, or a lower load"
    return Hint(NAME, (name,), message, remedy, _numbers(slip), slip.begin, slip.end)


def _let_go(slip: FullSlip) -> Hint:
    torque, speed = slip.torque_unit, slip.speed_unit
    more = slip.after * (slip.end - slip.begin) / (slip.before - slip.after)
    message = (
        f"never locks: its slip falls from {shown(slip.before, speed)} to {shown(slip.after, speed)} at"
        f" {slip.end:.4g} s, where its load is taken away; it transmits {shown(slip.kinetic, torque)} while it slips"
    )
    remedy = f"keep it fully applied for about {more:.3g} s more"
    return Hint(
        NAME, (slip.branch.name,), message, remedy, _numbers(slip) | {"missing [s]": more}, slip.begin, slip.end
    )


def _numbers(slip: FullSlip) -> dict[str, float]:
    torque, speed = slip.torque_unit, slip.speed_unit
    return {
        f"needed [{torque}]": slip.needed,
        f"slipping torque [{torque}]": slip.kinetic,
        f"capacity [{torque}]": slip.capacity,
        f"slip [{speed}]": slip.after,
    }
