"""A contact that starts locked and cannot hold its load."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from clutchwork.hints.hint import Hint, shown
from clutchwork.hints.look import Look, RowSpan
from clutchwork.hints.registry import run_rule
from clutchwork.results.channels import TORQUE

NAME = "breaks away at the start"


@run_rule(NAME)
def breaks_away_at_the_start(look: Look) -> Iterator[Hint]:
    """A contact that is set to start locked and breaks away in the first instant."""
    first = int(np.searchsorted(look.time, look.begin, "right")) - 1
    if first < 0:
        return
    for contact, branch in enumerate(look.contacts):
        if not branch.component.locked or branch.component.one_way or look.locked[first, contact]:
            continue
        unit, begin = TORQUE[branch.domain], look.begin
        capacity = float(look.part("contact_capacity")[first, contact])
        needed = abs(look.holding(contact, RowSpan(first, first))) if _moves(look, first, contact) else 0.0
        message = (
            f"is set to start locked but breaks away at {begin:.4g} s: holding takes {shown(needed, unit)},"
            f" its capacity there is {shown(capacity, unit)}"
        )
        remedy = "press it harder at the start, lower the load, or let it start open"
        numbers = {f"needed [{unit}]": needed, f"capacity [{unit}]": capacity}
        yield Hint(NAME, (branch.name,), message, remedy, numbers, begin, begin)


def _moves(look: Look, row: int, contact: int) -> bool:
    return look.motion.ease(contact, look.locked_at(row)) > 0.0
