"""What is differentiated, and what is found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options
    from clutchwork.gradients.parameters import Tunable
    from clutchwork.sweeps.outputs import Output

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class GradientTask:
    """What is differentiated: a System, its values by name, its numbers, and how it is run."""

    system: System
    outputs: Mapping[str, Output]
    parameters: Sequence[Tunable]
    t_end: float  # s
    options: Options
    threads: int
    labels: Sequence[str]  # names of all values
    side: str | None = None  # left or right, where derivatives from both sides differ


class GradientValues(NamedTuple):
    """Values and derivatives at one point."""

    values: Array
    matrix: Array
    notes: tuple[str, ...] = ()
    problems: tuple[str, ...] = ()  # why derivatives are missing
