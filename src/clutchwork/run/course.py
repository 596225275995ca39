"""What happens to a run from outside, and when: stretches of the core, and what is set before each of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from typing import Any, NamedTuple, Protocol

from clutchwork.base.classes import dataclass


class Course(Protocol):
    """Stretches of a run from one instant to the next."""

    def stops(self, begin: float, t_end: float) -> Iterator[float]:
        """Instants up to which the core may run, the last one the end [s]."""

    def act(self, run: Any, time: float, number: int) -> bool:
        """Set what is due before the stretch of a number; False when there is nothing to do."""

    def outside(self, number: int) -> tuple[Mapping[str, float], Mapping[str, Any]]:
        """Signals and parameters that are set from outside after so many stretches."""


class Act(NamedTuple):
    """One thing that was set: a signal, a signal that follows its model again, or a parameter."""

    kind: str  # "input", "release", "param" or "control"
    name: str
    value: Any  # None: that of the model
    numbers: tuple[tuple[int, float], ...]  # what the core is told, by place

    def apply(self, run: Any) -> None:
        """Tell the core."""
        for place, value in self.numbers:
            if self.kind == "param":
                run.set_param(place, value)
            elif self.kind == "release":
                run.release_input(place)
            else:
                run.set_input(place, value)


@dataclass
class Tape:
    """What was done to a run that was stepped, so that it can be repeated bit for bit."""

    held: Mapping[str, float] = field(default_factory=dict)  # at its begin
    changed: Mapping[str, Any] = field(default_factory=dict)
    ends: list[float] = field(default_factory=list)  # of the stretches [s]
    acts: dict[int, list[Act]] = field(default_factory=dict)  # by the number of the stretch that they precede

    def copy(self, length: int | None = None) -> Tape:
        """The same up to a number of stretches."""
        length = len(self.ends) if length is None else length
        acts = {number: list(acts) for number, acts in self.acts.items() if number <= length}
        return Tape(self.held, self.changed, self.ends[:length], acts)

    def note(self, act: Act) -> None:
        """Something was set before the next stretch."""
        self.acts.setdefault(len(self.ends), []).append(act)

    def stops(self, begin: float, t_end: float) -> Iterator[float]:  # noqa: ARG002, where it began is known
        """Ends of the stretches; a run that was not stepped yet ends where it begins."""
        yield from self.ends or (t_end,)

    def act(self, run: Any, time: float, number: int) -> bool:  # noqa: ARG002, the number says it
        """Repeat what was set."""
        if number == 0:
            run.expect_inputs(True)
        acts = self.acts.get(number, ())
        for one in acts:
            one.apply(run)
        return bool(acts)

    def outside(self, number: int) -> tuple[Mapping[str, float], Mapping[str, Any]]:
        """Signals and parameters that are set from outside after so many stretches."""
        held, changed = dict(self.held), dict(self.changed)
        for before in sorted(self.acts):
            for one in self.acts[before] if before < number else ():
                if one.kind in ("input", "release"):
                    _put(held, one)
                elif one.kind == "param":
                    _put(changed, one)
        return held, changed


def _put(known: dict[str, Any], act: Act) -> None:
    if act.value is None:
        known.pop(act.name, None)
    else:
        known[act.name] = act.value
