"""What is set from outside: by name, checked, as acts on a run of the core."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from clutchwork.assembly.changes import owners_of
from clutchwork.assembly.during_runs import NOTHING
from clutchwork.base.errors import Problem
from clutchwork.base.quote import quote
from clutchwork.declare.quantity import has_unit
from clutchwork.model.changes import Target, field_of, in_si, target
from clutchwork.run.input_schedule import Act, put
from clutchwork.signals.table import Table
from clutchwork.stepping.parameters import Change, changed
from clutchwork.stepping.signals import Settable, given_by_others, signals, unknown
from clutchwork.stepping.tables import tabled

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.schema import Spec
    from clutchwork.results.state import State

PART_OF_SIGNAL = ("is a part of a signal, which the model gives", "set the signal itself to a number")
NOT_A_NUMBER = ("must be a number", "a signal over time, or a friction law, belongs into the model")


class ChangePlan(NamedTuple):
    """What is to be done, and all that is wrong with it."""

    acts: list[Act]
    problems: list[Problem]
    present: System | None = None  # the System with all parameters, where they change


class ParameterTarget(NamedTuple):
    """Where the name of a parameter leads to: its present value and its declaration."""

    aim: Target
    value: Any
    spec: Spec


class Outside:
    """Signals and parameters of a System that are set from outside."""

    def __init__(self, system: System) -> None:
        self.signals: dict[str, Settable] = signals(system)
        self.held: dict[str, float | Table] = {}
        self.changed: dict[str, Any] = {}
        self._base = self._present = system

    def begin(self, state: State | None) -> tuple[dict[str, float | Table], dict[str, Any]]:
        """What is set in a state; nothing at the start of a model."""
        self.held = dict(state.held) if state else {}
        self.changed = dict(state.changed) if state else {}
        self._present = self._base.changed(self.changed) if self.changed else self._base
        return dict(self.held), dict(self.changed)

    def plan(self, given: Mapping[Any, Any], time: float) -> ChangePlan:
        """How values are set by name at a time [s]; None: that of the model again."""
        acts, problems, params = list[Act](), list[Problem](), dict[str, Any]()
        for name, value in given.items():
            linked = given_by_others(self._base, name) if isinstance(name, str) else unknown(self._base, name)
            if name in self.signals:
                act, found = self._signal(name, value, time)
                acts.append(act)
                problems += found
            elif linked is not None:
                problems.append(linked)
            else:
                params[name] = value
        more = self._parameters(params) if params else ChangePlan([], [])
        return ChangePlan(acts + more.acts, problems + more.problems, more.present)

    def take(self, plan: ChangePlan) -> None:
        """Remember what was done."""
        for act in plan.acts:
            put(self.changed if act.kind == "param" else self.held, act.name, act.value)
        self._present = plan.present or self._present

    def _signal(self, name: str, value: Any, time: float) -> tuple[Act, list[Problem]]:
        signal = self.signals[name]
        if isinstance(value, Table):
            return tabled(self._base, name, signal, value, time)
        if value is None:
            return self._released(name, signal.numbers), []
        number, problems = signal.read(value)
        return Act("input", name, number, signal.told(number)), problems

    def _released(self, name: str, numbers: tuple[int, ...]) -> Act:
        counts = self._base.arrays["input_count"]
        # where the system says nothing, a controller does
        return Act("release", name, None, tuple((number, 0.0) for number in numbers if counts[number]))

    # --------------------------------------------------------------------------------------------------- parameters

    def _parameters(self, given: Mapping[str, Any]) -> ChangePlan:
        values, problems = dict[str, Any](), list[Problem]()
        for name, value in given.items():
            known = self._value(name)
            faults = [unknown(self._base, name)] if known is None else list(self._faults(name, value, known))
            problems += faults
            if known is not None and not faults:
                values[name] = in_si(known.aim, value) if has_unit(value) else plain(value)
        change, found = changed(self._base, self._present, self.changed, values) if values else (None, [])
        if change is None or problems:
            return ChangePlan([], problems + found)
        return self._acts(values, change)

    def _value(self, name: str) -> ParameterTarget | None:
        """Where a name leads to in the model."""
        aim = target(owners_of(self._present), name)
        return None if aim is None else ParameterTarget(aim, *field_of(aim))

    def _faults(self, name: str, value: Any, found: ParameterTarget) -> Iterator[Problem]:
        """What is wrong with a value beside what a model says of it."""
        if any(name.startswith(f"{signal}.") for signal in self.signals):
            yield Problem(name, "", PART_OF_SIGNAL[0], remedy=PART_OF_SIGNAL[1])
        elif (
            not has_unit(value)
            and found.spec.what in ("signal", "alternative", "law")
            and not isinstance(value, int | float | None)
        ):
            yield Problem(name, "", NOT_A_NUMBER[0], quote(value), NOT_A_NUMBER[1])

    def _acts(self, values: Mapping[str, Any], change: Change) -> ChangePlan:
        """Acts of a change that can be done; the first has the numbers of all."""
        acts, problems = list[Act](), list[Problem]()
        for name, value in values.items():
            known = self._value(name)
            if not change.params and value is not None and known is not None and known.value != value:
                problems.append(Problem(name, "", NOTHING.why, remedy=NOTHING.remedy))
            acts.append(Act("param", name, value, () if acts else tuple(change.params.items())))
        return ChangePlan([] if problems else acts, problems, change.new)


def plain(value: Any) -> Any:
    """A number of numpy as one of Python, which a file of a state can hold; anything else as it is."""
    return value.item() if isinstance(value, np.generic) else value
