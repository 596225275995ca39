"""A table over time as words of a System: where its knots stand there, and how the words follow from them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.gradients.parameters import Tunable
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[np.float64]
Places = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class TableWords:
    """The knots of a table, which of them are free, and the words of the signal that it is.

    A knot (t, y) is a piece that starts at t with the value y and the slope to the next knot: docs/theory/gradients.md
    (10). A table that begins after 0 has a constant piece before, two knots at one time have one piece.
    """

    points: Array  # knots as they are
    numbers: Places  # of the parameters that move them
    along: Array  # of each parameter: how it moves the knots
    begins: Places  # knots at which pieces begin, -1: before the first one
    copies: int  # signals that it is
    places: Places  # words of all starts, values and slopes
    at_start: Places  # words of the value at 0, one for each signal

    @classmethod
    def of(cls, system: System, inputs: Sequence[int], free: Sequence[tuple[int, Tunable]]) -> TableWords | None:
        """The words of a table of a System; None where the signal is another one.

        Parameters: inputs, numbers of the signals that it is; free, its parameters with their numbers.
        """
        signal = system.inputs[inputs[0]].signal
        if type(signal).segments is not Table.segments:
            return None
        points = np.array([[float(x), float(y)] for x, y in vars(signal)["points"]])
        begins = pieces(points)
        first = system.arrays["input_first"][list(inputs)].astype(np.int64)
        if any(system.arrays["input_count"][number] != len(begins) for number in inputs):
            return None
        along = np.zeros((len(free), *points.shape))
        for line, (_, one) in zip(along, free, strict=True):
            for place in one.places:
                line[place] = 1.0
        rows = (first[:, None] + np.arange(len(begins))).ravel()
        coef = system.starts["segment_coef"] // 8 + 12 * rows
        places = np.concatenate([system.starts["segment_time"] // 8 + rows, coef, coef + 1])
        numbers = np.array([number for number, _ in free])
        at_start = system.starts["input_value"] // 8 + np.array(inputs, dtype=np.int64)
        return cls(points, numbers, along, begins, len(inputs), places, at_start)

    @cached_property
    def _free(self) -> tuple[Places, Places, Places]:
        """Parameter, knot and coordinate of all that moves."""
        line, knot, column = np.nonzero(self.along)
        return self.numbers[line], knot, column

    def moved(self, x: Array) -> Array:
        """The knots for values of all parameters."""
        made, (numbers, knots, columns) = self.points.copy(), self._free
        made[knots, columns] = x[numbers]
        return made

    def holds(self, x: Array) -> bool:
        """Whether the pieces begin at the same knots for values of all parameters."""
        points = self.moved(x)
        rises = bool(np.all(np.diff(points[:, 0]) >= 0.0))
        return not self.moves_times or (rises and np.array_equal(pieces(points), self.begins))

    def write(self, words: Array, x: Array) -> None:
        """Write the words for values of all parameters."""
        numbers, at_start = numbers_of(self.moved(x), self.begins)
        words[self.places], words[self.at_start] = np.repeat(numbers, self.copies, axis=0).ravel(), at_start

    @cached_property
    def moves_times(self) -> bool:
        """Whether any of its parameters is the time of a knot."""
        return bool(np.any(self.along[:, :, 0]))

    def slopes(self, x: Array) -> Array:
        """Derivatives of the words in `places`, a column for each of its parameters."""
        return self._fixed_slopes if not self.moves_times else self._slopes(self.moved(x))

    @cached_property
    def _fixed_slopes(self) -> Array:
        return self._slopes(self.points)

    def _slopes(self, points: Array) -> Array:
        found = derivatives(points, self.along, self.begins)
        return np.repeat(found, self.copies, axis=1).reshape(len(found), -1).T


def pieces(points: Array) -> Places:
    """Knots at which the pieces of a table begin, -1 for a constant one before the first."""
    count = len(points)
    begins = np.flatnonzero(np.diff(points[:, 0]) > 0.0)
    before = [-1] if points[0, 0] > 0.0 else []
    return np.array([*before, *begins.tolist(), count - 1], dtype=np.int64)


def numbers_of(points: Array, begins: Places) -> tuple[Array, float]:
    """Starts, values and slopes of the pieces, and the value at 0."""
    made, inner = np.zeros((3, len(begins))), begins[_is_sloped(points, begins)]
    made[:2] = points[np.maximum(begins, 0)].T
    made[0, begins < 0] = 0.0
    step = points[inner + 1] - points[inner]
    made[2, _is_sloped(points, begins)] = step[:, 1] / step[:, 0]
    now = max(int(np.searchsorted(made[0], 0.0, "right")) - 1, 0)
    return made, float(made[1, now] + (0.0 - made[0, now]) * made[2, now])


def derivatives(points: Array, along: Array, begins: Places) -> Array:
    """Derivatives of starts, values and slopes of the pieces where the knots move along directions."""
    made, sloped = np.zeros((len(along), 3, len(begins))), _is_sloped(points, begins)
    inner = begins[sloped]
    made[:, :2] = along[:, np.maximum(begins, 0)].transpose(0, 2, 1)
    made[:, 0, begins < 0] = 0.0
    step, moved = points[inner + 1] - points[inner], along[:, inner + 1] - along[:, inner]
    made[:, 2, sloped] = (moved[:, :, 1] - step[:, 1] / step[:, 0] * moved[:, :, 0]) / step[:, 0]
    return made


def _is_sloped(points: Array, begins: Places) -> NDArray[np.bool_]:
    """Pieces that lead to another knot; those before the first and behind the last are constant."""
    return (begins >= 0) & (begins < len(points) - 1)
