"""An element in a state for which it has no data."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from clutchwork.hints.hint import Hint
from clutchwork.hints.look import Look
from clutchwork.hints.registry import run_rule

NAME = "unknown there"


@run_rule(NAME)
def unknown_there(look: Look) -> Iterator[Hint]:
    """Elements that run where their tables say nothing, such as a TorqueConverter whose wheels both turn backward."""
    elements = look.run.wiring.elements
    for first in elements:
        unknown = getattr(first.component, "unknown", None)
        if unknown is None or first.number:
            continue
        ways = [branch for branch in elements if branch.component is first.component]
        where, message, remedy = unknown({type(b.component).ways[b.number].name: look.rate(b) for b in ways})
        if not np.any(where):
            continue
        begin, end = (float(t) for t in look.time[np.flatnonzero(where)[[0, -1]]])
        between = f"between {begin:.4g} and {end:.4g} s it {message}"
        yield Hint(NAME, (first.component.name,), between, remedy, {"time [s]": end - begin}, begin, end)
