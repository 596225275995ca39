"""How a signal follows from an output row: plain data, so that it can be evaluated here and written as C."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.declare.layout import MODES

Array = NDArray[Any]
Rows = NDArray[np.float64]

LOCKED = next(number for number, name in MODES.items() if name == "locked")
STATE_NAMES = np.array([MODES[number] for number in sorted(MODES)])
FIRST_MODE = min(MODES)


@dataclass(frozen=True)
class RowEntry:
    """A number of the row as it stands."""

    index: int

    def __call__(self, rows: Rows) -> Array:
        """Values on a matrix of rows."""
        return rows[:, self.index]


@dataclass(frozen=True)
class Affine:
    """offset + scale * number."""

    index: int
    scale: float
    offset: float = 0.0

    def __call__(self, rows: Rows) -> Array:
        """Values on a matrix of rows."""
        return self.offset + self.scale * rows[:, self.index]


@dataclass(frozen=True)
class Total:
    """Sum of numbers of the row, or minus that."""

    indices: tuple[int, ...]
    negative: bool = False

    def __call__(self, rows: Rows) -> Array:
        """Values on a matrix of rows."""
        total = sum((rows[:, index] for index in self.indices[1:]), rows[:, self.indices[0]])
        return -total if self.negative else total


@dataclass(frozen=True, eq=False)
class Dot:
    """Product with a constant vector; columns with factor 0 are left out, for they may be infinite.

    Terms are added in their order, so that a row has the same value whatever rows stand beside it.
    """

    used: NDArray[np.intp]
    factors: Array

    @classmethod
    def of(cls, vector: Array) -> Dot:
        """From a vector over the whole row."""
        used = np.flatnonzero(vector)
        return cls(used, vector[used])

    def __call__(self, rows: Rows) -> Array:
        """Values on a matrix of rows."""
        terms = [factor * rows[:, index] for index, factor in zip(self.used, self.factors, strict=True)]
        return sum(terms[1:], terms[0]) if terms else np.zeros(len(rows))


@dataclass(frozen=True)
class Slip:
    """Slip of a contact; exactly zero while it is locked."""

    rate: Dot
    mode: int

    def __call__(self, rows: Rows) -> Array:
        """Values on a matrix of rows."""
        return np.where(rows[:, self.mode] == LOCKED, 0.0, self.rate(rows))


@dataclass(frozen=True)
class Power:
    """Product of a torque and a rate."""

    torque: Total | Dot
    rate: Dot | Slip

    def __call__(self, rows: Rows) -> Array:
        """Values on a matrix of rows."""
        return self.torque(rows) * self.rate(rows)


@dataclass(frozen=True)
class Powers:
    """Sum of powers."""

    parts: tuple[Power, ...]

    def __call__(self, rows: Rows) -> Array:
        """Values on a matrix of rows."""
        powers = [part(rows) for part in self.parts]
        return sum(powers[1:], powers[0])


@dataclass(frozen=True)
class Mode:
    """Mode of a contact, a number of layout.MODES, or its name."""

    index: int
    named: bool = False

    def __call__(self, rows: Rows) -> Array:
        """Values on a matrix of rows."""
        numbers = rows[:, self.index].astype(int)
        return STATE_NAMES[numbers - FIRST_MODE] if self.named else numbers


Form = RowEntry | Affine | Total | Dot | Slip | Power | Powers | Mode
