"""A contact that what presses it leaves."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from clutchwork.hints.hint import Hint
from clutchwork.hints.look import Look
from clutchwork.hints.registry import run_rule

NAME = "lifts off"


@run_rule(NAME)
def lifts_off(look: Look) -> Iterator[Hint]:
    """A contact without load in a part of the run, which says of itself that this is rarely wanted."""
    for contact, branch in enumerate(look.contacts):
        why, remedy = branch.component.lifts or ("", "")
        bare = np.flatnonzero(look.part("contact_capacity")[:, contact] <= 0.0)
        if why and len(bare):
            begin = float(look.time[int(bare[0])])
            yield Hint(NAME, (branch.name,), f"transmits nothing at {begin:.4g} s: {why}", remedy, {}, begin, begin)
