"""A shaft that nothing is attached to."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from clutchwork.assembly.wiring import wiring
from clutchwork.hints.hint import Hint
from clutchwork.hints.registry import model_rule

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

NAME = "joined to nothing"


@model_rule(NAME)
def joined_to_nothing(system: System) -> Iterator[Hint]:
    """A shaft or mass with no element, gear or contact at it, in a model that has some."""
    parts = wiring(system)
    acting = (*(part for part in parts.elements if not part.hidden), *parts.contacts, *parts.motions)
    touched = {node for branch in acting for node in branch.direction}
    touched |= {node for gear in parts.gears for node, _ in gear.ports.values()}
    for number, node in enumerate(parts.nodes) if touched else ():
        if number not in touched:
            message = "is joined to nothing: no element acts on it, so it never changes its speed"
            yield Hint(NAME, (node.name,), message, "attach an element to it, or remove it")
