"""Jumps of a formula, found where one of its conditions changes between two of the inputs at which it is checked."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from clutchwork.laws.bases.expression import PRESSURE, SLIP, TEMPERATURE

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from clutchwork.laws.bases.program import Program

Inputs = dict[str, float]

# operations whose results jump, and what counts as a jump of a coefficient or a rate, of its size
CONDITIONS = ("less", "sign")
JUMP = 1e-6
# slips [rad/s] at which conditions over temperature and pressure are looked for, and a value of the states
SOME_SLIPS = (0.1, 1.0, 10.0, 100.0)
STATE = 0.1
HALVINGS = 60


def first_jump(program: Program, places: Sequence[Mapping[str, float]], slips: Sequence[float]) -> str:
    """The first jump in words: "jumps from 0.4 to 0.2 at a slip of 3 rad/s"; empty where there is none.

    Parameters: places, inputs other than the slip; slips, rising.
    """
    first = 3 + len(program.states) + len(program.names) + len(program.constants)
    conditions = [first + k for k, node in enumerate(program.nodes) if node.operation in CONDITIONS]
    if not conditions:
        return ""
    results = (program.coefficient, program.at_rest, *program.rates)

    def seen(at: Inputs) -> tuple[list[float], list[float]]:
        registers = program.run({**dict.fromkeys(program.states, STATE), **at})
        return [registers[i] for i in conditions], [registers[i] for i in results]

    for before, after in _segments(places, slips):
        if seen(before)[0] == seen(after)[0]:
            continue
        low, high = before, after
        sizes = [max(abs(a), abs(b)) for a, b in zip(seen(before)[1], seen(after)[1], strict=True)]
        for _ in range(HALVINGS):
            middle = {name: 0.5 * (low[name] + high[name]) for name in low}
            low, high = (middle, high) if seen(middle)[0] == seen(before)[0] else (low, middle)
        for one, other, size in zip(seen(low)[1], seen(high)[1], sizes, strict=True):
            if abs(one - other) > JUMP * max(abs(one), abs(other), size):
                return f"jumps from {one:g} to {other:g} {where(program, high)}"
    return ""


def _segments(places: Sequence[Mapping[str, float]], slips: Sequence[float]) -> Iterator[tuple[Inputs, Inputs]]:
    """Neighbouring inputs, which differ in one of them."""
    for place in places:
        for before, after in pairwise(slips):
            yield {**place, SLIP: before}, {**place, SLIP: after}
    for one, other in pairwise(places):
        for slip in SOME_SLIPS:
            yield {**one, SLIP: slip}, {**other, SLIP: slip}


def where(program: Program, at: Mapping[str, float]) -> str:
    """Values of the inputs in words: "at a slip of 3 rad/s and 400 K"."""
    said = [f"a slip of {at.get(SLIP, 0.0):g} rad/s"]
    said += [f"{at[TEMPERATURE]:g} K"] if TEMPERATURE in program.reads else []
    said += [f"{at[PRESSURE]:g} Pa"] if PRESSURE in program.reads else []
    return f"at {' and '.join(said)}"
