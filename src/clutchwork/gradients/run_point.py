"""A point that is differentiated at, and the run there."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.functional import Functional
from clutchwork.gradients.primal import Knots, Primal
from clutchwork.gradients.steps import Steps
from clutchwork.gradients.words import Chart, Slopes
from clutchwork.sweeps.outputs import Output

Array = NDArray[np.float64]

NO_TANGENTS = np.zeros((0, 0, 0))


class RunPoint(NamedTuple):
    """A point with what is known of its run before it is differentiated."""

    x: Array
    sizes: Array  # of the numbers
    chart: Chart
    words: Array
    slopes: Slopes
    knots: Knots
    steps: Steps
    events: Array  # s, of a run without derivatives
    by_rows: Mapping[Output, float]  # what rows of that run say: squared jerks, extremes in short steps
    grid: Array  # s, instants of rows
    notes: tuple[str, ...]  # on what is only just differentiable
    looked_at: tuple[float, ...] = ()  # s, when it is looked at whether anything rests at a border

    @property
    def system(self) -> bytes:
        """The bytes of the System."""
        return self.words.tobytes()


class Run(NamedTuple):
    """A run, and the derivatives of what follows from it to first order."""

    primal: Primal
    slope: Callable[[Functional], Array]
    is_forward: bool  # whether derivatives of the times of all events are known
    notes: tuple[str, ...]
    tangents: Array = NO_TANGENTS  # of the numbers of all rows by each number, of a forward run
