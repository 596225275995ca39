"""The bytes of a System as words of eight bytes, and which of them are numbers."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelWarning
from clutchwork.declare.layout import FIELDS
from clutchwork.gradients.parameters import Tunable, changes

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[np.float64]


def words_of(system: System) -> Array:
    """The bytes of a System as numbers."""
    return np.frombuffer(system.to_bytes(), dtype=np.float64)


def made(system: System, parameters: Sequence[Tunable], x: Array) -> System:
    """A System with other values; ModelError where the driveline refuses them."""
    with warnings.catch_warnings():
        # what is rarely wanted was said of the driveline
        warnings.simplefilter("ignore", ModelWarning)
        return system.changed(changes(system, parameters, x))


def finite(words: Array) -> Array:
    """Words without those that are not a number, as a parameter that is left out."""
    return np.where(np.isfinite(words), words, 0.0)


@dataclass(frozen=True, eq=False)
class WordStructure:
    """The words of a System, which of them are numbers, and which say how it is built."""

    words: Array
    is_number: NDArray[np.bool_]

    @classmethod
    def of(cls, system: System) -> WordStructure:
        """That of a System."""
        words = words_of(system)
        is_number = np.zeros(len(words), dtype=bool)
        for name, kind, _, _ in FIELDS:
            if kind == "f8":
                first = system.starts[name] // 8
                is_number[first : first + system.arrays[name].size] = True
        return cls(words, is_number)

    def is_that_of(self, words: Array) -> bool:
        """Whether other words are built alike: they have the same length, and the same words that are not numbers."""
        if len(words) != len(self.words):
            return False
        fixed = ~self.is_number
        return np.array_equal(words.view(np.int64)[fixed], self.words.view(np.int64)[fixed])
