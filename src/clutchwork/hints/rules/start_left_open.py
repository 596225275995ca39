"""A speed at the start that nobody gave."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from clutchwork.hints.hint import Hint
from clutchwork.hints.registry import model_rule
from clutchwork.model.start import LEFT_OPEN

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

NAME = "start left open"


@model_rule(NAME)
def start_left_open(system: System) -> Iterator[Hint]:
    """A shaft that turns at the start because others are at rest, as a note of the assembly has it."""
    for note in system.notes:
        if LEFT_OPEN in note:
            told, _, others = note.partition(LEFT_OPEN)
            (name,), resting = re.findall(r'"([^"]*)"', told), re.findall(r'"([^"]*)"', others)
            speed = told.rpartition(": starts at ")[2]
            message = f"starts at {speed} because what was added before it starts at rest ({', '.join(resting)})"
            remedy = "give the speed of one more of these shafts, which the given ones leave open"
            yield Hint(NAME, (name, *resting), message, remedy)
