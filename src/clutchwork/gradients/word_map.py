"""How the words of one structure of a driveline follow from numbers: written in place, or assembled."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.provenance import PROBES, parameter
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError
from clutchwork.gradients.assembled import Assembled
from clutchwork.gradients.system_words import WordStructure, words_made
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
        return self.assembled.system.starts[name] // 8, self.assembled.system.arrays[name].size

    @classmethod
    def of(cls, system: System, parameters: tuple[Tunable, ...], x: Array) -> Chart:
        """Look at how the words of a System, which has these values, follow from them."""
        structure, known = WordStructure.of(system), {one.field: parameter(system, one.field) for one in parameters}
        words, counts = np.unique(np.concatenate([entry.words for entry in known.values()]), return_counts=True)
        scalars, tables = dict[int, Places](), list[TableWords]()
        for name, own in known.items():
            free = [(number, one) for number, one in enumerate(parameters) if one.field == name]
            # what goes into a word together with others is assembled
            if np.isin(own.words, words[counts > 1]).any():
                continue
            if own.is_word:
                scalars[free[0][0]] = own.words
            elif own.is_signal and free[0][1].places:
                found = TableWords.of(system, own.inputs, free)
                tables += [found] if found else []
        for written, signals in ((scalars, tables), ({}, tables)):
            used = {*written, *(number for table in signals for number in table.numbers.tolist())}
            bound = [number for number in range(len(x)) if number not in used]
            rest = _assembled(system, structure, [parameters[number] for number in bound], x[bound])
            chart = cls(written, tuple(signals), bound, rest, x == 0.0)
            # numbers that are assembled may make another structure
            held = (chart._holds(system, parameters, x, fixed) for fixed in ([], bound))
            if next((one for one in held if one is not None), False):
                return chart
        return replace(chart, tables=(), bound=[*range(len(x))], assembled=_assembled(system, structure, parameters, x))

    def _holds(self, system: System, parameters: Sequence[Tunable], x: Array, fixed: Sequence[int]) -> bool | None:
        """Whether the words are right where all numbers but those that are fixed are others, of which some were zero.

        None where the structure is another one there.
        """
        moves = np.array([_room(one, value) for one, value in zip(parameters, x.tolist(), strict=True)])
        moves[list(fixed)] = 0.0
        for there in (x + share * moves for share in PROBES):
            try:
                words = words_made(system, parameters, there)
            except ModelError:
                continue
            own = self._written(there)
            alike = self.assembled.structure.is_that_of(words)
            return own is not None and own.tobytes() == words.tobytes() if alike else None
        return None

    def words(self, x: Array) -> Array | None:
        """The words at a point; None where the structure may be another one there, or numbers only fit together."""
        written = [*self.scalars]
        return self._written(x) if np.array_equal((x == 0.0)[written], self.zeros[written]) else None

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


def _room(one: Tunable, value: float) -> float:
    """By how much a number may move without another structure: a knot at 0 stays there."""
    return min(one.scale, one.reach) * (value != 0.0) if np.isfinite(one.reach) else one.scale


def _assembled(system: System, structure: WordStructure, chosen: Sequence[Tunable], x: Array) -> Assembled:
    """Numbers that words are assembled from; sums where none of the others goes into their words."""
    own = [parameter(system, one.field) for one in chosen]
    rest = (one.words for one in own if one.is_word or one.derivative is None)
    others = np.concatenate([np.zeros(0, dtype=np.int64), *rest])
    sums = {n: one for n, one in enumerate(own) if one.derivative is not None and not np.isin(one.words, others).any()}
    return Assembled(system, structure, tuple(chosen), x, sums)
