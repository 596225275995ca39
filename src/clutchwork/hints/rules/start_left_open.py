"""A speed at the start that nobody gave."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from clutchwork.hints.hint import Hint
from clutchwork.hints.registry import model_rule
from clutchwork.model.start import LEFT_OPEN

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

NAME = "start left open"


def _named(system: System, note: str) -> tuple[str, ...]:
    """Shafts and masses that a note names."""
    return tuple(node.name for node in system.nodes if f' "{node.name}"' in note)


@model_rule(NAME)
def start_left_open(system: System) -> Iterator[Hint]:
    """A shaft that turns at the start because others are at rest, as a note of the assembly has it."""
    for note in system.notes:
        if LEFT_OPEN in note:
            told, _, others = note.partition(LEFT_OPEN)
            moving, resting = _named(system, told), _named(system, others)
            speed = told.rpartition(": starts at ")[2]
            message = f"starts at {speed} because what was added before it starts at rest ({', '.join(resting)})"
            remedy = "give the speed of one more of these shafts, which the given ones leave open"
            yield Hint(NAME, (*moving, *resting), message, remedy)
