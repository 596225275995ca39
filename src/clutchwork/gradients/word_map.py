"""How the words of one structure of a driveline follow from numbers: written in place, or assembled."""

from __future__ import annotations

from bisect import bisect_left
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError
from clutchwork.gradients.assembled import Assembled
from clutchwork.gradients.discovery import identity, tables, together
from clutchwork.gradients.system_words import WordStructure
from clutchwork.gradients.tables import TableWords

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.parameters import Tunable

Array = NDArray[np.float64]
Places = NDArray[np.int64]


class Slopes(NamedTuple):
    """Words that change with numbers, and their derivatives: a line for each word, a column for each number."""

    places: Places
    matrix: Array

    def within(self, first: int, count: int) -> slice:
        """Lines of the words that change among some that follow each other."""
        return slice(bisect_left(self.places, first), bisect_left(self.places, first + count))

    def touch(self, first: int, count: int) -> bool:
        """Whether any of them changes."""
        return bisect_left(self.places, first) < bisect_left(self.places, first + count)

    def of(self, words: Places) -> Array:
        """Derivatives of words: a line for each."""
        made = np.zeros((len(words), self.matrix.shape[1]))
        at = np.searchsorted(self.places, words)
        there = np.isin(words, self.places)
        made[there] = self.matrix[at[there]]
        return made


@dataclass(frozen=True, eq=False)
class Chart:
    """The words as functions of numbers, as long as the structure stays."""

    scalars: dict[int, Places]  # words that are a number themselves
    tables: tuple[TableWords, ...]
    bound: list[int]  # numbers that words are assembled from
    assembled: Assembled
    zeros: NDArray[np.bool_]  # numbers that are zero here: with another one an element may have a state more

    def words_in(self, name: str) -> tuple[int, int]:
        """The first word of an array of a System, and how many there are."""
        return self._places[name]

    @cached_property
    def _places(self) -> dict[str, tuple[int, int]]:
        starts = self.assembled.structure.layout.starts
        return {name: (starts[name] // 8, array.size) for name, array in self.assembled.system.arrays.items()}

    @classmethod
    def of(cls, system: System, parameters: tuple[Tunable, ...], x: Array) -> Chart:
        """Look at how the words of a System, which has these values, follow from them."""
        structure = WordStructure.of(system)
        found = ((n, identity(system, structure, one, float(x[n]))) for n, one in enumerate(parameters))
        scalars = {number: places for number, places in found if places is not None}
        signals = tuple(tables(system, structure, parameters))
        for written in (scalars, {}):
            chart = cls._with(system, structure, parameters, x, written, signals)
            held = chart.holds(together(system, parameters, x, []))
            # numbers that are assembled may make another structure
            if chart.holds(together(system, parameters, x, chart.bound)) if held is None else held:
                return chart
        return cls._with(system, structure, parameters, x, {}, ())

    @classmethod
    def _with(
        cls,
        system: System,
        structure: WordStructure,
        parameters: tuple[Tunable, ...],
        x: Array,
        scalars: dict[int, Places],
        signals: tuple[TableWords, ...],
    ) -> Chart:
        written = {*scalars, *(number for table in signals for number in table.numbers)}
        bound = [number for number in range(len(x)) if number not in written]
        chosen = tuple(parameters[number] for number in bound)
        return cls(scalars, signals, bound, Assembled(system, structure, chosen, x[bound]), x == 0.0)

    def holds(self, given: tuple[Array, Array]) -> bool | None:
        """Whether the words at a point are those that are given; None where the structure is another one there."""
        there, words = given
        if not len(words) or not self.assembled.structure.is_that_of(words):
            return None
        own = self._written(there)
        return own is not None and own.tobytes() == words.tobytes()

    def words(self, x: Array) -> Array | None:
        """The words at a point; None where the structure may be another one there, or numbers only fit together."""
        changed = (x == 0.0) != self.zeros
        return None if changed.any() and changed[[*self.scalars]].any() else self._written(x)

    def _written(self, x: Array) -> Array | None:
        try:
            assembled = self.assembled.words(x[self.bound])
        except ModelError:
            return None
        if assembled is None:
            return None
        words = assembled.copy()
        for number, places in self.scalars.items():
            words[places] = x[number]
        return words if all(table.written(words, x) for table in self.tables) else None

    def slopes(self, x: Array) -> Slopes:
        """Derivatives of the words at a point; NoGradient where there is none."""
        return self._fixed or self._slopes(x)

    @cached_property
    def _fixed(self) -> Slopes | None:
        """Derivatives that are the same everywhere: nothing is assembled, and no knot moves in time."""
        numbers = {*self.scalars, *(number for table in self.tables for number in table.numbers.tolist())}
        free = self.bound or any(table.moves_times for table in self.tables)
        return None if free else self._slopes(np.zeros(len(numbers)))

    def _slopes(self, x: Array) -> Slopes:
        more = self.assembled.slopes(x[self.bound]) if self.bound else None
        known = np.flatnonzero(more.any(axis=1)) if more is not None else np.zeros(0, dtype=np.int64)
        places = np.unique(np.concatenate([known, *self.scalars.values(), *(table.places for table in self.tables)]))
        matrix = np.zeros((len(places), len(x)))
        for number, own in self.scalars.items():
            matrix[np.searchsorted(places, own), number] = 1.0
        for table in self.tables:
            matrix[np.ix_(np.searchsorted(places, table.places), table.numbers)] = table.slopes(x)
        if more is not None:
            matrix[np.searchsorted(places, known)[:, None], self.bound] = more[known]
        return Slopes(places, matrix)
