"""Numbers at kinks of the driveline itself, such as a signal that begins with the run: others have derivatives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.finite_differences import TIED
from clutchwork.gradients.task import GradientTask
from clutchwork.results.gradient import NoGradient


class Bends(Exception):  # noqa: N818, it is caught where it is raised
    """Numbers at kinks of the driveline, and what is said of each."""

    def __init__(self, numbers: Mapping[int, str]) -> None:
        super().__init__()
        self.numbers = numbers

    def is_tied(self, number: int) -> bool:
        """Whether there is no value beside a number: what is forgiven of rounding makes no derivative."""
        return TIED in self.numbers[number]


def bends_of(none: NoGradient, task: GradientTask) -> Exception:
    """Those that have no derivative; what was said itself where it is of the run."""
    found = {
        number: problem
        for number, one in enumerate(task.parameters)
        for problem in none.problems
        if problem.startswith(f"{one.name} = ")
    }
    return Bends(found) if found else none


def spread(numbers: NDArray[Any], kept: NDArray[np.bool_], fill: float) -> NDArray[Any]:
    """Numbers at the places that are kept, others filled."""
    made = np.full(len(kept), fill, dtype=numbers.dtype)
    made[kept] = numbers
    return made
