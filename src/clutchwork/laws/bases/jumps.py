"""Jumps of a formula, where a condition or the sign of a denominator changes between two inputs of its check."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

from clutchwork.laws.bases.expression import INPUTS, PRESSURE, SLIP, TEMPERATURE

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from clutchwork.laws.bases.program import Program

Inputs = dict[str, float]

# operations whose results jump, and what counts as a jump of a coefficient or a rate, of its size
CONDITIONS = ("less", "sign")
JUMP = 1e-6
# which of their operands divides; nearer to its zero than so many halvings a quotient is round-off
DENOMINATORS = {"divide": 1, "add_quotient": 2, "subtract_quotient": 2}
FEW_HALVINGS = 27
# slips [rad/s] at which conditions over temperature and pressure are looked for, and a value of the states
SOME_SLIPS = (0.1, 1.0, 10.0, 100.0)
STATE = 0.1
HALVINGS = 60


class FormulaJump(NamedTuple):
    """A result of a formula that differs on both sides of a condition."""

    before: float
    after: float
    at: Inputs
    of_coefficient: bool
    from_rest: bool  # whether it lies between a slip of exactly zero and all others


def first_jump(program: Program, places: Sequence[Mapping[str, float]], slips: Sequence[float]) -> FormulaJump | None:
    """The first jump; None where there is none.

    Parameters: places, inputs other than the slip; slips, rising.
    """
    first = len(INPUTS) + len(program.states) + len(program.names) + len(program.constants)
    conditions = [first + k for k, node in enumerate(program.nodes) if node.operation in CONDITIONS]
    divisors = [node.of[DENOMINATORS[node.operation]] for node in program.nodes if node.operation in DENOMINATORS]
    # numbers of the law and constants stay
    divisors = [i for i in divisors if i < len(INPUTS) or i >= first]
    if not conditions and not divisors:
        return None
    results = (program.coefficient, program.at_rest, *program.rates)

    def seen(at: Inputs) -> tuple[tuple[list[float], list[bool]], list[float]]:
        registers = program.run({**dict.fromkeys(program.states, STATE), **at})
        told = [registers[i] for i in conditions], [registers[i] > 0.0 for i in divisors]
        return told, [registers[i] for i in results]

    looked: tuple[Inputs, Any] = ({}, None)
    for before, after in _segments(places, slips):
        own, first_values = looked[1] if looked[0] == before else seen(before)
        others, last_values = seen(after)
        looked = after, (others, last_values)
        if own == others:
            continue
        low, high = before, after
        sizes = [max(abs(a), abs(b)) for a, b in zip(first_values, last_values, strict=True)]
        for _ in range(HALVINGS if own[0] != others[0] else FEW_HALVINGS):
            middle = {name: 0.5 * (low[name] + high[name]) for name in low}
            low, high = (middle, high) if seen(middle)[0] == own else (low, middle)
        for place, (one, other, size) in enumerate(zip(seen(low)[1], seen(high)[1], sizes, strict=True)):
            if abs(one - other) > JUMP * max(abs(one), abs(other), size):
                return FormulaJump(one, other, high, place == 0, slips[0] == low[SLIP] == 0.0 < high[SLIP])
    return None


def _segments(places: Sequence[Mapping[str, float]], slips: Sequence[float]) -> Iterator[tuple[Inputs, Inputs]]:
    """Neighbouring inputs, which differ in one of them."""
    for place in places:
        for before, after in pairwise(slips):
            yield {**place, SLIP: before}, {**place, SLIP: after}
    for one, other in pairwise(places):
        for slip in SOME_SLIPS:
            yield {**one, SLIP: slip}, {**other, SLIP: slip}


def where(program: Program, at: Mapping[str, float], unit: str = "rad/s") -> str:
    """Values of the inputs in words: "at a slip of 3 rad/s and 400 K"."""
    said = [f"a slip of {at.get(SLIP, 0.0):g} {unit}"]
    said += [f"{at[TEMPERATURE]:g} K"] if TEMPERATURE in program.reads else []
    said += [f"{at[PRESSURE]:g} Pa"] if PRESSURE in program.reads else []
    return f"at {' and '.join(said)}"
