"""Gears that say the same."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from clutchwork.hints.hint import Hint
from clutchwork.hints.registry import model_rule

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

NAME = "redundant gear"
END = ": one of them is redundant"


@model_rule(NAME)
def redundant_gear(system: System) -> Iterator[Hint]:
    """Gears of which one follows from the others, as a note of the assembly has it."""
    for note in system.notes:
        if note.endswith(END):
            names = tuple(re.findall(r'"([^"]*)"', note))
            message = "one of these gears follows from the others, so how they share their load is a convention"
            remedy = "remove one of them if the split of their torques matters"
            yield Hint(NAME, names, message, remedy)
