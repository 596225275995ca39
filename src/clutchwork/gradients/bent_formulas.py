"""Formulas that rest on a bend of theirs: a slip that stays exactly where two numbers of a `max` are equal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import takewhile
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import HOUSING, Branch, wiring
from clutchwork.base.memoize import memoize
from clutchwork.declare.schema import WORDS, specs
from clutchwork.laws.bases.expression import SLIP
from clutchwork.laws.bases.formula import FormulaLaw
from clutchwork.laws.bases.program import Program
from clutchwork.results.forms import LOCKED

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.run_point import Run, RunPoint

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# so near to a bend a formula rests there, of each of its numbers
NEAR = 1e-9
# inputs of formulas beside the slip, whose values rows do not have
UNKNOWN = ("temperature", "pressure")
# operations that bend where their numbers are equal, and where theirs is zero
EQUAL, ZERO = ("smaller", "larger", "less"), ("size", "sign")


class Bending(NamedTuple):
    """A contact whose formula bends."""

    number: int
    name: str
    law: FormulaLaw
    program: Program
    places: Mapping[str, int]  # of its numbers among all parameters
    direction: Mapping[int, float]  # of its slip


def bent_formulas(system: System, point: RunPoint, run: Run) -> Iterator[tuple[str, Mask]]:
    """What is said of formulas that are at a bend, and the numbers that move their slip or are in them."""
    for one in formulas(system):
        for time in point.looked_at:
            numbers = _moved(one, point, run, time)
            if numbers.any():
                why = f"the formula of {one.name} is at a bend at {time:.9g} s, at which its slip may rest"
                yield why, numbers


def _moved(one: Bending, point: RunPoint, run: Run, time: float) -> Mask:
    primal, first = run.primal, point.chart.words_in("params")[0]
    row, none = primal.row(time), np.zeros(len(point.x), dtype=bool)
    if primal.rows[row, primal.columns["contact_mode"].start + one.number] == LOCKED:
        return none
    columns = primal.columns["speed"].start + np.array([*one.direction], dtype=np.intp)
    shares = np.array([*one.direction.values()])
    slip = float(primal.rows[row, columns] @ shares)
    words = np.array([first + place for place in one.places.values()], dtype=np.intp)
    given = {SLIP: abs(slip) if one.law.sticks else slip}
    given.update(zip(one.places, point.words[words].tolist(), strict=True))
    if not is_at_bend(one.program, given, max(NEAR, primal.rtol)):
        return none
    moves = primal.functional()
    moves.add(np.array([row]), columns, shares[None])
    found: Mask = (run.slope(moves) != 0.0) | (point.slopes.of(words) != 0.0).any(axis=0)
    return found


def is_at_bend(program: Program, given: Mapping[str, float], near: float) -> bool:
    """Whether numbers of a formula, moved by so little of them, take it over a bend."""
    for name, value in given.items():
        less, more = (_sides(program, {**given, name: value * (1.0 + sign * near)}) for sign in (-1.0, 1.0))
        # what is equal everywhere, or no number, does not bend
        if np.any(less != more):
            return True
    return False


def _sides(program: Program, given: Mapping[str, float]) -> Array:
    """The sign of what each operation that bends decides by."""
    registers, found = program.run(given), list[float]()
    for node in program.nodes:
        if node.operation in EQUAL:
            found.append(registers[node.of[0]] - registers[node.of[1]])
        elif node.operation in ZERO:
            found.append(registers[node.of[0]])
    return np.sign(np.nan_to_num(found))


@memoize
def formulas(system: System) -> tuple[Bending, ...]:
    """Contacts whose formulas bend over their slip and numbers alone."""
    offsets = system.arrays["contact_law_param"].tolist()
    return tuple(_found(wiring(system).contacts, offsets))


def _found(contacts: tuple[Branch, ...], offsets: list[int]) -> Iterator[Bending]:
    for number, branch in enumerate(contacts):
        law = branch.component.friction
        if not isinstance(law, FormulaLaw) or not law.bends or law.own_states() or any(map(law.reads, UNKNOWN)):
            continue
        program, _ = law._program  # noqa: SLF001, of one's own kind
        if program is None:
            continue
        direction = {node: share for node, share in branch.direction.items() if node != HOUSING}
        places = {name: offsets[number] + _place(type(law), name) for name in program.names}
        yield Bending(number, branch.name, law, program, places, direction)


def _place(law: type, name: str) -> int:
    """The place of a number among those of its law."""
    before = takewhile(lambda one: one[0].name != name, specs(law, *WORDS))
    return sum(1 if spec.what == "param" else 2 for _, spec in before)
