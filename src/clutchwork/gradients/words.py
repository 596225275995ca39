"""From numbers of a driveline to words of its System: the words for any values, and their derivatives.

docs/theory/gradients.md (10) and (11)
"""

from __future__ import annotations

from dataclasses import field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.gradients.system_words import made, words_of
from clutchwork.gradients.word_map import Chart, Slopes

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.parameters import Tunable

Array = NDArray[np.float64]

# structures of a driveline that are remembered
MOST_CHARTS = 8


@dataclass(frozen=True, eq=False)
class Words:
    """The words of a System as functions of numbers."""

    system: System
    parameters: tuple[Tunable, ...]
    _charts: list[Chart] = field(default_factory=list, repr=False)

    def at(self, x: Array) -> tuple[Chart, Array]:
        """The words at a point, and how they follow from it; ModelError for values that the driveline refuses."""
        system = self.assembled(x)
        words = words_of(system)
        chart = next((one for one in self._charts if one.holds(words, x)), None)
        if chart is None:
            chart = Chart.of(system, self.parameters, x)
            self._charts[:] = [chart, *self._charts[: MOST_CHARTS - 1]]
        return chart, words

    def bytes_at(self, x: Array) -> bytes:
        """The bytes of the System at a point."""
        return self.assembled(x).to_bytes()

    def slopes_at(self, x: Array) -> Slopes:
        """Derivatives of the words at a point; NoGradient where a number has none."""
        return self.at(x)[0].slopes(x)

    def assembled(self, x: Array) -> System:
        """The System at a point."""
        return (
            self.system
            if np.array_equal(x, [one.start for one in self.parameters])
            else made(self.system, self.parameters, x)
        )
