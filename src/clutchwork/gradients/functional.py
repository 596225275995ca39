"""A value of a run to first order: how it follows from rows, from instants of events, and from the numbers themselves.

Forward derivatives weigh the tangents of rows and events by it; an adjoint run takes it as it is.
docs/theory/gradients.md (7)
"""

from __future__ import annotations

from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass

Array = NDArray[np.float64]
Places = NDArray[np.intp]


@dataclass
class Functional:
    """A weighted sum of numbers of rows, of times of events and guards, and of the free numbers themselves."""

    direct: Array  # of each number
    rows: list[Places] = field(default_factory=list)
    columns: list[Places] = field(default_factory=list)
    weights: list[Array] = field(default_factory=list)
    events: list[tuple[int, float]] = field(default_factory=list)

    def add(self, rows: Places, columns: Places, weights: Array) -> None:
        """Weights of a matrix of numbers: a line for each row, a column for each place in it."""
        alone = len(rows) == 1
        self.rows.append(rows.repeat(len(columns)))
        self.columns.append(columns if alone else np.tile(columns, len(rows)))
        self.weights.append(np.ascontiguousarray(weights, dtype=float).ravel())

    def add_event(self, number: int, weight: float) -> None:
        """Weight of the time of an event; of a guard that was hit, whose numbers follow those of the events."""
        self.events.append((number, weight))

    def _flat(self) -> tuple[Places, Places, Array]:
        none = np.zeros(0, dtype=np.intp)
        return (
            np.concatenate([none, *self.rows]),
            np.concatenate([none, *self.columns]),
            np.concatenate([np.zeros(0), *self.weights]),
        )

    def along(self, rows: Array, events: Array) -> Array:
        """The derivatives by the numbers.

        Parameters: rows, tangents of the numbers of all rows; events, those of the times of all events and guards.
        """
        row, column, weight = self._flat()
        found: Array = self.direct + weight @ rows[row, column]
        for number, share in self.events:
            found = found + share * events[number]
        return found

    def into(self, rows: Array, events: Array) -> None:
        """Add it to the weights of all numbers of rows, and of all events and guards."""
        row, column, weight = self._flat()
        np.add.at(rows, (row, column), weight)
        for number, own in self.events:
            events[number] += own

    def include(self, other: Functional, share: float) -> None:
        """Add a share of another one."""
        self.direct = self.direct + share * other.direct
        self.rows += other.rows
        self.columns += other.columns
        self.weights += [share * weight for weight in other.weights]
        self.events += [(number, share * own) for number, own in other.events]
