"""What happens to a run from outside, and when: stretches of the core, and what is set before each of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from functools import cached_property
from math import isfinite
from typing import Any, NamedTuple, Protocol

import numpy as np

from clutchwork.base import dataclass
from clutchwork.results.external_settings import Held, held_of, plain_held, plain_value, value_of

# by place, of a table its segments
Numbers = tuple[tuple[int, Any], ...]
KINDS = ("input", "release", "param", "control", "segments")


class Schedule(Protocol):
    """Stretches of a run from one instant to the next."""

    def stops(self, begin: float, t_end: float) -> Iterator[float]:
        """Instants up to which the core may run, the last one the end [s]."""

    def act(self, run: Any, time: float, number: int) -> bool:
        """Set what is due before the stretch of a number; False when there is nothing to do."""

    def outside(self, number: int) -> tuple[Held, Mapping[str, Any]]:
        """Signals and parameters that are set from outside after so many stretches."""

    def plain(self) -> dict[str, Any] | None:
        """What a file holds of it; None where the model and the state at the begin say all."""


class Act(NamedTuple):
    """One thing that was set: a signal, its segments, a signal that follows its model again, or a parameter."""

    kind: str  # one of KINDS
    name: str
    value: Any  # None: that of the model
    numbers: Numbers  # what the core is given, by place

    def apply(self, run: Any) -> None:
        """Do it in the core."""
        for place, value in self.numbers:
            if self.kind == "param":
                run.set_param(place, value)
            elif self.kind == "release":
                run.release_input(place)
            elif self.kind == "segments":
                rows = np.array(value)
                run.set_segments(place, rows[:, 0].copy(), rows[:, 1:].copy())
            else:
                run.set_input(place, value)


@dataclass
class Tape:
    """What was done to a run that was stepped, so that it can be repeated bit for bit."""

    held: Held = field(default_factory=dict)  # at its begin
    changed: Mapping[str, Any] = field(default_factory=dict)
    ends: list[float] = field(default_factory=list)  # of the stretches [s]
    # number of the stretch that it precedes, then the fields of an Act: plain tuples, which cost collectors nothing
    noted: list[tuple[int, str, str, Any, Numbers]] = field(default_factory=list)

    def copy(self) -> Tape:
        """The same, to be kept."""
        return Tape(self.held, self.changed, self.ends[:], self.noted[:])

    def plain(self) -> dict[str, Any]:
        """What a file holds of it."""
        noted = [(*line[:3], plain_value(line[3]), line[4]) for line in self.noted]
        return {"held": plain_held(self.held), "changed": dict(self.changed), "ends": self.ends, "noted": noted}

    @classmethod
    def of_plain(cls, data: Any, inputs: int, params: int) -> Tape:
        """The tape that a file holds, of a System with so many inputs and parameters; ValueError for anything else."""
        kinds = {"held": dict, "changed": dict, "ends": list, "noted": list}
        if not isinstance(data, dict) or any(not isinstance(data.get(name), kind) for name, kind in kinds.items()):
            raise ValueError("what was done to it is damaged")
        ends = [float(end) for end in data["ends"]]
        if not all(isfinite(end) for end in ends) or ends != sorted(ends):
            raise ValueError("its steps are damaged")
        return cls(
            held_of(data["held"]), data["changed"], ends, [_noted(line, inputs, params) for line in data["noted"]]
        )

    @cached_property
    def acts(self) -> dict[int, list[Act]]:
        """Acts by the number of the stretch that they precede, of a tape that is kept."""
        found = dict[int, list[Act]]()
        for number, *act in self.noted:
            found.setdefault(number, []).append(Act(*act))
        return found

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

    def outside(self, number: int) -> tuple[Held, Mapping[str, Any]]:
        """Signals and parameters that are set from outside after so many stretches."""
        held, changed = dict(self.held), dict(self.changed)
        for before, kind, name, value, _ in self.noted:
            if before < number and kind != "control":
                put(changed if kind == "param" else held, name, value)
        return held, changed


def _noted(line: Any, inputs: int, params: int) -> tuple[int, str, str, Any, Numbers]:
    """An act and the number of the stretch that it precedes, as a file holds it."""
    number, kind, name, value, numbers = line
    table = kind == "segments"
    made = tuple((int(place), tuple(map(_segment, one)) if table else float(one)) for place, one in numbers)
    most = params if kind == "param" else inputs
    if kind not in KINDS or not all(0 <= place < most for place, _ in made):
        raise ValueError("the settings made during the run are damaged")
    return int(number), str(kind), str(name), value_of(value) if table else value, made


def _segment(line: Any) -> tuple[float, ...]:
    """A segment as a file holds it: its start and its twelve numbers."""
    made = tuple(float(one) for one in line)
    if len(made) != 13 or not all(map(isfinite, made)):
        raise ValueError("a table that was set is damaged")
    return made


def put(known: dict[str, Any], name: str, value: Any) -> None:
    """Remember what is set; None: it is no more."""
    if value is None:
        known.pop(name, None)
    else:
        known[name] = value
