"""A lining that is hotter than any lining stands."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.results.hints.hint import Hint, shown
from clutchwork.results.hints.registry import run_rule

if TYPE_CHECKING:
    from clutchwork.results.hints.look import Look

NAME = "too hot"
# what dry linings stand for a short time [K], of docs/elements/_linings.md: sintered metal, and all others
SINTERED, OTHERS = 773.0, 623.0


@run_rule(NAME)
def too_hot(look: Look) -> Iterator[Hint]:
    """A contact whose heat node is above the highest temperature that any lining stands for a short time."""
    for branch in look.contacts:
        path = branch.component.heat_path()
        if path is None or path.node.capacity is None:
            continue
        warm = look.fine[f"{branch.name}.temperature"]
        top = int(np.argmax(warm))
        if warm[top] <= SINTERED:
            continue
        begin, end = (float(t) for t in look.time[np.flatnonzero(warm > SINTERED)[[0, -1]]])
        message = (
            f"reaches {shown(float(warm[top]), 'K')} at {look.time[top]:.4g} s and is above {SINTERED:g} K from"
            f" {begin:.4g} to {end:.4g} s: sintered metal stands {SINTERED:g} K for a short time, all other linings at"
            f" most {OTHERS:g} K"
        )
        remedy = (
            f"check the capacity of {path.node.name}, {shown(path.node.capacity, 'J/K')}, and its cooling, or slip less"
        )
        numbers = {"temperature [K]": float(warm[top]), "limit [K]": SINTERED}
        yield Hint(NAME, (branch.name,), message, remedy, numbers, begin, end)
