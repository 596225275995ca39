"""How a signal follows from an output row of the core: its value, its derivatives, and how others evaluate it.

A form is described here alone: what runs, sweeps, gradients, linear systems, pages and exported C need of it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.c_literal import literal
from clutchwork.declare.layout import MODES

Array = NDArray[Any]
Rows = NDArray[np.float64]
Places = Mapping[int, int]  # where a number of the row stands in another one

LOCKED = next(number for number, name in MODES.items() if name == "locked")
STATE_NAMES = np.array([MODES[number] for number in sorted(MODES)])
FIRST_MODE = min(MODES)


class Weights(NamedTuple):
    """Derivatives of a signal by numbers of its rows: places in a row, and a line of derivatives for each row."""

    columns: NDArray[np.intp]
    values: Rows


class Form(ABC):
    """A signal as a function of a row."""

    @abstractmethod
    def __call__(self, rows: Rows) -> Array:
        """Values on a matrix of rows."""

    @abstractmethod
    def reads(self) -> set[int]:
        """Places of the row that it follows from."""

    @abstractmethod
    def over(self, places: Places) -> Any:
        """The same form over rows that hold its numbers at other places."""

    @abstractmethod
    def weights(self, rows: Rows) -> Weights:
        """Derivatives by the numbers of each row. docs/theory/gradients.md (8)."""

    @abstractmethod
    def c(self, columns: Sequence[str]) -> str:
        """A C expression of `row`, from the identifiers of all its numbers."""

    @abstractmethod
    def data(self) -> list[Any]:
        """A letter, then numbers and inner forms, of which there are sums and products: what a page evaluates."""

    def is_rate_of_structure(self) -> bool:
        """Whether it is a rate without a radius or a ratio in it."""
        return self.is_of_structure()

    def is_of_structure(self) -> bool:
        """Whether it is the same for all drivelines of one structure: free of ratios, inertias and stiffnesses."""
        return True


@dataclass(frozen=True)
class RowEntry(Form):
    """A number of the row as it stands."""

    index: int

    def __call__(self, rows: Rows) -> Array:
        return rows[:, self.index]

    def reads(self) -> set[int]:
        return {self.index}

    def over(self, places: Places) -> RowEntry:
        return RowEntry(places[self.index])

    def weights(self, rows: Rows) -> Weights:
        return _constant([self.index], [1.0], rows)

    def c(self, columns: Sequence[str]) -> str:
        return f"row[{columns[self.index]}]"

    def data(self) -> list[Any]:
        return ["c", int(self.index)]


@dataclass(frozen=True)
class Affine(Form):
    """offset + scale * number."""

    index: int
    scale: float
    offset: float = 0.0

    def __call__(self, rows: Rows) -> Array:
        return self.offset + self.scale * rows[:, self.index]

    def reads(self) -> set[int]:
        return {self.index}

    def over(self, places: Places) -> Affine:
        return Affine(places[self.index], self.scale, self.offset)

    def weights(self, rows: Rows) -> Weights:
        return _constant([self.index], [self.scale], rows)

    def c(self, columns: Sequence[str]) -> str:
        return f"{literal(self.offset)} + {literal(self.scale)} * row[{columns[self.index]}]"

    def data(self) -> list[Any]:
        return ["a", int(self.index), float(self.scale), float(self.offset)]

    def is_of_structure(self) -> bool:
        return False


@dataclass(frozen=True)
class Total(Form):
    """Sum of numbers of the row, or minus that."""

    indices: tuple[int, ...]
    negative: bool = False

    def __call__(self, rows: Rows) -> Array:
        total = sum((rows[:, index] for index in self.indices[1:]), rows[:, self.indices[0]])
        return -total if self.negative else total

    def reads(self) -> set[int]:
        return set(self.indices)

    def over(self, places: Places) -> Total:
        return Total(tuple(places[index] for index in self.indices), self.negative)

    def weights(self, rows: Rows) -> Weights:
        return _constant(self.indices, [-1.0 if self.negative else 1.0] * len(self.indices), rows)

    def c(self, columns: Sequence[str]) -> str:
        total = " + ".join(f"row[{columns[index]}]" for index in self.indices)
        return f"-({total})" if self.negative else total

    def data(self) -> list[Any]:
        return ["t", [int(index) for index in self.indices], self.negative]


@dataclass(frozen=True, eq=False)
class Dot(Form):
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
        total: Array | None = None
        for index, factor in zip(self.used.tolist(), self.factors.tolist(), strict=True):
            column = rows[:, index]
            # most factors are signs, which need no product
            if total is not None and factor == -1.0:
                total = total - column
                continue
            term = column if factor == 1.0 else factor * column
            total = term if total is None else total + term
        return np.zeros(len(rows)) if total is None else total

    def reads(self) -> set[int]:
        return {int(index) for index in self.used}

    def over(self, places: Places) -> Dot:
        return Dot(np.array([places[int(index)] for index in self.used], dtype=np.intp), self.factors)

    def weights(self, rows: Rows) -> Weights:
        return _constant(self.used, self.factors, rows)

    def c(self, columns: Sequence[str]) -> str:
        terms = [f"{literal(f)} * row[{columns[k]}]" for k, f in zip(self.used, self.factors, strict=True)]
        return " + ".join(terms) or "0.0"

    def data(self) -> list[Any]:
        return ["l", [int(index) for index in self.used], [float(factor) for factor in self.factors]]

    def is_rate_of_structure(self) -> bool:
        return bool(np.all(np.abs(self.factors) == 1.0))

    def is_of_structure(self) -> bool:
        return False


@dataclass(frozen=True)
class Slip(Form):
    """Slip of a contact; exactly zero while it is locked."""

    rate: Dot
    mode: int

    def __call__(self, rows: Rows) -> Array:
        return np.where(rows[:, self.mode] == LOCKED, 0.0, self.rate(rows))

    def reads(self) -> set[int]:
        return self.rate.reads() | {self.mode}

    def over(self, places: Places) -> Slip:
        return Slip(self.rate.over(places), places[self.mode])

    def weights(self, rows: Rows) -> Weights:
        found = self.rate.weights(rows)
        return Weights(found.columns, found.values * (rows[:, self.mode] != LOCKED)[:, None])

    def c(self, columns: Sequence[str]) -> str:
        return f"row[{columns[self.mode]}] == {literal(LOCKED)} ? 0.0 : {self.rate.c(columns)}"

    def data(self) -> list[Any]:
        return ["s", self.rate.data(), int(self.mode)]

    def is_of_structure(self) -> bool:
        return self.rate.is_rate_of_structure()


@dataclass(frozen=True)
class Power(Form):
    """Product of a torque and a rate."""

    torque: Total | Dot
    rate: Dot | Slip

    def __call__(self, rows: Rows) -> Array:
        return self.torque(rows) * self.rate(rows)

    def reads(self) -> set[int]:
        return self.torque.reads() | self.rate.reads()

    def over(self, places: Places) -> Power:
        return Power(self.torque.over(places), self.rate.over(places))

    def weights(self, rows: Rows) -> Weights:
        one, other = self.torque.weights(rows), self.rate.weights(rows)
        parts = [one.values * self.rate(rows)[:, None], other.values * self.torque(rows)[:, None]]
        return Weights(np.concatenate([one.columns, other.columns]), np.concatenate(parts, axis=1))

    def c(self, columns: Sequence[str]) -> str:
        return f"({self.torque.c(columns)}) * ({self.rate.c(columns)})"

    def data(self) -> list[Any]:
        return ["p", self.torque.data(), self.rate.data()]

    def is_of_structure(self) -> bool:
        return self.torque.is_of_structure() and self.rate.is_rate_of_structure()


@dataclass(frozen=True)
class Powers(Form):
    """Sum of powers, each a product or a number of the row."""

    parts: tuple[Power | RowEntry, ...]

    def __call__(self, rows: Rows) -> Array:
        powers = [part(rows) for part in self.parts]
        return sum(powers[1:], powers[0])

    def reads(self) -> set[int]:
        return all_reads(self.parts)

    def over(self, places: Places) -> Powers:
        return Powers(tuple(part.over(places) for part in self.parts))

    def weights(self, rows: Rows) -> Weights:
        found = [part.weights(rows) for part in self.parts]
        columns = np.concatenate([one.columns for one in found])
        return Weights(columns, np.concatenate([one.values for one in found], axis=1))

    def c(self, columns: Sequence[str]) -> str:
        return " + ".join(part.c(columns) for part in self.parts)

    def data(self) -> list[Any]:
        return ["q", [part.data() for part in self.parts]]

    def is_of_structure(self) -> bool:
        return all(part.is_of_structure() for part in self.parts)


@dataclass(frozen=True)
class Mode(Form):
    """Mode of a contact, a number of layout.MODES, or its name."""

    index: int
    named: bool = False

    def __call__(self, rows: Rows) -> Array:
        numbers = rows[:, self.index].astype(int)
        return STATE_NAMES[numbers - FIRST_MODE] if self.named else numbers

    def reads(self) -> set[int]:
        return {self.index}

    def over(self, places: Places) -> Mode:
        return Mode(places[self.index], self.named)

    def weights(self, rows: Rows) -> Weights:
        return _constant([], [], rows)

    def c(self, columns: Sequence[str]) -> str:
        return f"row[{columns[self.index]}]"

    def data(self) -> list[Any]:
        return ["c", int(self.index)]


def all_reads(forms: Iterable[Form]) -> set[int]:
    """Places of the row that any of the forms follows from."""
    return set[int]().union(*(form.reads() for form in forms))


def is_of_structure(signal: str, form: Form) -> bool:
    """Whether the form of a signal is the same for all drivelines of one structure."""
    return form.is_rate_of_structure() if signal.endswith(".rate") else form.is_of_structure()


def _constant(columns: Any, factors: Any, rows: Rows) -> Weights:
    """The same derivatives in all rows."""
    return Weights(np.array(columns, dtype=np.intp), np.ones((len(rows), 1)) * np.array(factors, dtype=float))
