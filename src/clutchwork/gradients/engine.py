"""What gives values and derivatives: one interface, whatever is behind it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options
    from clutchwork.gradients.parameters import Parameter
    from clutchwork.sweeps.outputs import Output

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Task:
    """What is differentiated: a System, its values by name, its numbers, and how it is run."""

    system: System
    outputs: Mapping[str, Output]
    parameters: Sequence[Parameter]
    t_end: float  # s
    options: Options
    threads: int
    labels: Sequence[str]  # names of all values


class Found(NamedTuple):
    """Values and derivatives at one point."""

    values: Array
    matrix: Array
    notes: tuple[str, ...] = ()


class Engine(Protocol):
    """Runs with other numbers."""

    def values(self, x: Array) -> Array:
        """Values for each line of numbers, NaN where there is none."""

    def gradient(self, x: Array) -> Found:
        """Values and derivatives at a point; NoGradient where there is none."""

    def gradients(self, x: Array) -> tuple[Array, Array]:
        """The same for each line of numbers; NaN where there is none."""

    def product(self, x: Array, weights: Array) -> tuple[Array, Array]:
        """Values at a point, and the derivatives of their weighted sum."""


def stacked(found: Mapping[str, Any], count: int) -> Array:
    """Values of outputs, each of one or several numbers, as lines of numbers."""
    return np.concatenate([np.asarray(one, dtype=float).reshape(count, -1) for one in found.values()], axis=1)
