"""What the independent solver asks of a law."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

Array = np.ndarray


class Branch(NamedTuple):
    """Direction of the slip, which holds until the slip passes through zero, and a mark for each element."""

    way: int = 1
    marks: tuple[int, ...] = ()

    def marked(self, index: int, mark: int) -> Branch:
        """The same with another mark at one place."""
        return self._replace(marks=(*self.marks[:index], mark, *self.marks[index + 1 :]))


class Guard(NamedTuple):
    """A function of slip and states that falls through zero where the branch ends, and what happens there."""

    value: Callable[[float, Array], float]
    switch: Callable[[Array, Branch], tuple[Array, Branch]]


@dataclass(frozen=True)
class Law:
    """Coefficient of friction over slip and states, smooth on each branch; as it stands without states or kinks."""

    @property
    def size(self) -> int:
        """Number of states."""
        return 0

    @property
    def kinked(self) -> bool:
        """Whether the branch ends where the slip passes through zero."""
        return self.size > 0

    def start(self) -> Branch:
        """The branch at rest with states of zero."""
        return Branch()

    def coefficient(self, v: float, s: Array, branch: Branch) -> float:
        """Friction against positive slip per unit of normal load."""
        raise NotImplementedError

    def rates(self, v: float, s: Array, branch: Branch) -> list[float]:
        """Time derivatives of the states."""
        return []

    def turned(self, s: Array, branch: Branch) -> tuple[Array, Branch]:
        """States and marks after the slip passed through zero; the direction is the affair of the solver."""
        return s, branch

    def guards(self, branch: Branch) -> list[Guard]:
        """Ends of this branch other than the slip at zero."""
        return []
