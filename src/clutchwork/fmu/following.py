"""Outputs that follow from parameters themselves, not from the run alone: their forms follow along straight lines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.base import ModelError
from clutchwork.declare.options import Options
from clutchwork.fmu.terms import NumberOfForm, numbers_of
from clutchwork.fmu.variables import FmuVariable, VariableKind
from clutchwork.results.channels import channels

# where a number of the form of an output stands
Key = tuple[str, NumberOfForm]
Numbers = dict[Key, float]
# other values at which a straight line is tried; digits of sums are round-off
TRIED = 2
STRAIGHT = 1e-9


class ParameterLine(NamedTuple):
    """How a number follows a parameter, or its reciprocal, as a twist follows a stiffness."""

    slope: float
    is_reciprocal: bool

    def change(self, start: float, value: float) -> float:
        """What another value adds."""
        return self.slope * (1.0 / value - 1.0 / start if self.is_reciprocal else value - start)


ParameterLines = dict[Key, ParameterLine]


class Following(NamedTuple):
    """How numbers of outputs follow parameters, and the output that does not follow one along a line."""

    lines: dict[str, ParameterLines]
    left_out: dict[str, str]


def following(system: System, options: Options, numbers: Iterable[FmuVariable], outputs: Sequence[str]) -> Following:
    """How the forms of outputs follow numbers that are fixed during a run, all of them together.

    The torque of a gear, for example, follows from accelerations by the inertias behind it.
    """
    known = channels(system, options.angles, options.work)
    dependent = [name for name in outputs if not known[name].evaluate.is_of_structure()]
    base = _numbers(system, options, dependent)
    lines, left_out = dict[str, ParameterLines](), dict[str, str]()
    for one in numbers if dependent else ():
        if one.kind is not VariableKind.FIXED or not one.reaches_forms:
            continue
        found = _lines(system, options, one, base, dependent)
        if isinstance(found, str):
            left_out[one.name] = found
        elif found:
            lines[one.name] = found
    moves = {one.name: one for one in numbers if one.name in lines}
    while moves and (output := _does_not_add_up(system, options, moves, base, lines)):
        name = next(name for name in reversed(moves) if any(key[0] == output for key in lines[name]))
        left_out[name] = output
        del moves[name], lines[name]
    return Following(lines, left_out)


def _lines(
    system: System, options: Options, one: FmuVariable, base: Numbers, outputs: Sequence[str]
) -> ParameterLines | str:
    """How all numbers follow that a parameter moves; the name of an output where one follows along no line."""
    others = ((value, new) for value in one.far if (new := _changed(system, {one.path: value})) is not None)
    looks = [(value, _numbers(new, options, outputs)) for value, new in islice(others, TRIED)]
    for _, made in looks:
        if made.keys() != base.keys():
            return next(iter(made.keys() ^ base.keys()))[0]
    lines = ParameterLines()
    for key, number in base.items():
        changes = [(value, made[key] - number) for value, made in looks]
        if not any(change for _, change in changes):
            continue
        line = _line(one.start, changes)
        if line is None:
            return key[0]
        lines[key] = line
    return lines


def _line(start: float, changes: Sequence[tuple[float, float]]) -> ParameterLine | None:
    """The line through changes of a number by values of a parameter, or by their reciprocals."""
    for is_reciprocal in (False, True):
        if len(changes) < TRIED or (is_reciprocal and not all([start, *(value for value, _ in changes)])):
            continue
        value, change = changes[0]
        line = ParameterLine(1.0, is_reciprocal)
        line = ParameterLine(change / line.change(start, value), is_reciprocal)
        size = max(abs(change) for _, change in changes)
        if all(abs(line.change(start, value) - change) <= STRAIGHT * size for value, change in changes):
            return line
    return None


def _does_not_add_up(
    system: System,
    options: Options,
    moves: Mapping[str, FmuVariable],
    base: Numbers,
    lines: Mapping[str, ParameterLines],
) -> str:
    """An output of which a number differs from the sum of what each parameter does alone; empty: none does."""
    changes = {one.path: one.far[0] for one in moves.values()}
    outputs = list(dict.fromkeys(output for output, _ in base))
    other = _changed(system, changes)
    first = next(iter(next(iter(lines.values()))))[0]
    if other is None:
        return first
    made = _numbers(other, options, outputs)
    if made.keys() != base.keys():
        return next(iter(made.keys() ^ base.keys()))[0]
    for key, number in base.items():
        shifts = [lines[name][key].change(one.start, one.far[0]) for name, one in moves.items() if key in lines[name]]
        size = abs(number) + sum(map(abs, shifts))
        if not np.isclose(made[key], number + sum(shifts), rtol=0.0, atol=STRAIGHT * size):
            return key[0]
    return ""


def _changed(system: System, changes: Mapping[str, float]) -> System | None:
    """The System with other values; None where they are refused."""
    try:
        return system.changed(dict(changes))
    except ModelError:
        return None


def _numbers(system: System, options: Options, names: Iterable[str]) -> Numbers:
    known = channels(system, options.angles, options.work)
    return {(name, at): value for name in names for at, value in numbers_of(known[name].evaluate).items()}
