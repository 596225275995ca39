"""A lining that is hotter than it stands."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from clutchwork.hints.hint import Hint, shown
from clutchwork.hints.look import Look
from clutchwork.hints.registry import run_rule

NAME = "too hot"
# what dry linings stand for a short time [K], of docs/elements/_linings.md: sintered metal, and all others
SINTERED, OTHERS = 773.0, 623.0
ANY_LINING = f"sintered metal stands {SINTERED:g} K for a short time, all other linings at most {OTHERS:g} K"


@run_rule(NAME)
def too_hot(look: Look) -> Iterator[Hint]:
    """A contact whose heat node is above its limit; without one, above what any lining stands for a short time."""
    for branch in look.contacts:
        path = branch.component.heat_path()
        if path is None or path.node.capacity is None:
            continue
        warm = look.fine[f"{branch.name}.temperature"]
        top = int(np.argmax(warm))
        limit, known = path.node.limit or SINTERED, path.node.limit is not None
        if warm[top] <= limit:
            continue
        begin, end = (float(t) for t in look.time[np.flatnonzero(warm > limit)[[0, -1]]])
        why = f"its limit is {limit:g} K" if known else ANY_LINING
        message = (
            f"reaches {shown(float(warm[top]), 'K')} at {look.time[top]:.4g} s and is above {limit:g} K from"
            f" {begin:.4g} to {end:.4g} s: {why}"
        )
        remedy = (
            f"check the capacity of {path.node.name}, {shown(path.node.capacity, 'J/K')}, and its cooling, or slip less"
        )
        numbers = {"temperature [K]": float(warm[top]), "limit [K]": limit}
        yield Hint(NAME, (branch.name,), message, remedy, numbers, begin, end)
