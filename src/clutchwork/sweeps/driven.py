"""Inputs of elements with other values, looked at without the element around them: what differs is the signal alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from clutchwork.assembly.inputs import plain_signal
from clutchwork.assembly.patches import Numbered, Patch, signal_patches
from clutchwork.base import ModelError, Problem
from clutchwork.declare.node import Component, Signal
from clutchwork.declare.schema import Spec, specs
from clutchwork.declare.to_si import settled
from clutchwork.declare.wording import path_of
from clutchwork.model.changes import renewed
from clutchwork.model.fields import At, signal_problems
from clutchwork.model.numbers import is_right
from clutchwork.sweeps.mistakes import few

if TYPE_CHECKING:
    from clutchwork.sweeps.system_words import Line

# what an element may make of its inputs before a run
HOOKS = ("problems", "initial_states", "state_scales")


@dataclass(frozen=True, eq=False)
class IndependentInput:
    """An input of an element that nothing else of the element depends on."""

    owner: Component
    name: str
    spec: Spec
    given: Any

    @classmethod
    def of(cls, owner: Any, name: str) -> IndependentInput | None:
        """The input of a name; None where it is something else, or more follows from it."""
        kind = type(owner)
        if not isinstance(owner, Component) or kind.hooks or kind.ways:
            return None
        if any(getattr(kind, hook) is not getattr(Component, hook) for hook in HOOKS):
            return None
        spec = next((spec for item, spec in specs(kind, "signal", "alternative") if item.name == name), None)
        given = getattr(owner, name)
        if spec is None or not isinstance(given, float | int | Signal):
            return None
        return cls(owner, name, settled(name, spec, kind, vars(owner)), given)

    def patches(self, where: Numbered, changes: Sequence[Line], most: int) -> list[list[Patch]]:
        """Patches of the System for each line of changes; ModelError names all that are wrong, up to a maximum."""
        at, problems = At(path_of(self.owner), "").inner(self.name, self.spec.unit), list[Problem]()
        made, name = list[list[Patch]](), f"{self.owner.name}.{self.name}"
        for line in changes:
            value = self._value(line)
            found = [] if is_right(value, self.spec) else list(signal_problems(value, self.spec, at))
            problems += found
            if not found and not problems:
                made.append(list(signal_patches(where, name, plain_signal(value))))
        if problems:
            raise ModelError(few(problems, most))
        return made

    def _value(self, line: Line) -> Any:
        """The whole input with other values."""
        (path, value), *more = line
        if len(path) == 1 and not more:
            return value
        return renewed(self.given, [(path[1:], value) for path, value in line])

    def fits(self, changes: Sequence[Line]) -> bool:
        """Whether all values are numbers or signals; a reference to another element is looked at as a whole."""
        return all(len(path) > 1 or isinstance(value, float | Signal) for line in changes for path, value in line)
