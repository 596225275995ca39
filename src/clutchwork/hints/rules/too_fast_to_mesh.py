"""A dog clutch that starts in mesh, with a slip at which teeth do not mesh."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from clutchwork.assembly.wiring import HOUSING, wiring
from clutchwork.hints.hint import Hint, shown
from clutchwork.hints.registry import model_rule

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

NAME = "too fast to mesh"


@model_rule(NAME)
def too_fast_to_mesh(system: System) -> Iterator[Hint]:
    """A DogClutch with engaged=True whose shafts turn past each other faster than its `speed` at the start."""
    motions = [int(number) for number in system.prescribed_input]
    speeds = system.basis @ system.initial_speed + system.basis_prescribed @ system.input_value[motions]
    for branch in wiring(system).elements:
        dog = branch.component
        if not getattr(dog, "engaged", False):
            continue
        slip = abs(sum(factor * float(speeds[k]) for k, factor in branch.direction.items() if k != HOUSING))
        if slip > dog.speed:
            message = (
                f"is engaged at the start, but slips there with {shown(slip, 'rad/s')}, above the"
                f" {shown(dog.speed, 'rad/s')} at which its teeth mesh: it transmits nothing"
            )
            remedy = "give its shafts the same speed at the start, or let it start out of mesh"
            yield Hint(NAME, (branch.name,), message, remedy, {"slip [rad/s]": slip, "speed [rad/s]": dog.speed})
