"""From unknowns to the numbers of a model: each sets one number, or multiplies or shifts several together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.calibration.together import FACTOR, SHIFT, VALUE


@dataclass(frozen=True)
class Variable:
    """One unknown: what it does to which numbers, and its bounds."""

    name: str
    kind: str  # VALUE, FACTOR or SHIFT
    numbers: tuple[str, ...]
    low: float
    high: float
    unit: str = ""


class Moves:
    """How a vector of unknowns changes a vector of numbers: values first, then factors, then shifts."""

    def __init__(self, unknowns: Sequence[Variable], numbers: Sequence[str]) -> None:
        place = {name: at for at, name in enumerate(numbers)}
        pairs = {
            kind: [
                (place[name], k) for k, one in enumerate(unknowns) if one.kind == kind for name in one.numbers
            ]
            for kind in (VALUE, FACTOR, SHIFT)
        }  # fmt: skip
        self.count, self.numbers = len(unknowns), len(numbers)
        self.values, self.factors, self.shifts = (
            (np.array([one[0] for one in found], dtype=np.intp), np.array([one[1] for one in found], dtype=np.intp))
            for found in pairs.values()
        )

    def apply(self, base: Array, x: Array) -> Array:
        """The numbers with the unknowns."""
        made = base.copy()
        made[self.values[0]] = x[self.values[1]]
        np.multiply.at(made, self.factors[0], x[self.factors[1]])
        np.add.at(made, self.shifts[0], x[self.shifts[1]])
        return made

    def passed(self, x: Array) -> Array:
        """Derivative of each number by what it was before."""
        made = np.ones(self.numbers)
        made[self.values[0]] = 0.0
        np.multiply.at(made, self.factors[0], x[self.factors[1]])
        return made

    def slopes(self, base: Array, x: Array) -> Array:
        """Derivatives of the numbers by the unknowns, shape (numbers, unknowns)."""
        made, factor = np.zeros((self.numbers, self.count)), np.ones(self.numbers)
        np.multiply.at(factor, self.factors[0], x[self.factors[1]])
        made[self.values] = factor[self.values[0]]
        before = base.copy()
        before[self.values[0]] = x[self.values[1]]
        numbers, unknowns = self.factors
        made[self.factors] += before[numbers] * factor[numbers] / x[unknowns]
        made[self.shifts] += 1.0
        return made

    def start(self, base: Array) -> Array:
        """The unknowns that change nothing."""
        made = np.zeros(self.count)
        made[self.factors[1]] = 1.0
        made[self.values[1]] = base[self.values[0]]
        return made
