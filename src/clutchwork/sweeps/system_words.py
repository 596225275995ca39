"""Words of eight bytes in the bytes of a System: where they are, and what they become with other values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.patches import Patch, Unpatched

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.sweeps.variants import Codes

Words = NDArray[np.uint64]
Places = NDArray[np.int64]
# values at paths of fields of one element
Line = Sequence[tuple[tuple[str, ...], Any]]


@dataclass(frozen=True, eq=False)
class Axis:
    """Places of words in the System, and what they are for each value of a name, or combination of several names."""

    names: tuple[str, ...]
    place: Places
    words: Words
    codes: Codes  # which of these each variant has


def words_of(system: System, found: Sequence[Sequence[Patch]]) -> tuple[Places, Words]:
    """Words of a System that any of many sets of patches changes, and their content for each set."""
    shapes, own = dict[tuple[tuple[str, int, int], ...], list[int]](), np.frombuffer(system.to_bytes(), dtype=np.uint64)
    for number, patches in enumerate(found):
        shape = tuple((patch.array, patch.start, len(patch.values)) for patch in patches)
        shapes.setdefault(shape, []).append(number)
    columns = dict[int, Words]()
    for shape, numbers in shapes.items():
        for which, (array, start, _) in enumerate(shape):
            values = [found[number][which].values for number in numbers]
            for offset, column in _changed(system.arrays[array], start, values):
                place = system.starts[array] // 8 + offset
                if place not in columns:
                    columns[place] = np.full(len(found), own[place])
                columns[place][numbers] = column
    places = sorted(columns)
    empty = np.zeros((len(found), 0), dtype=np.uint64)
    return np.array(places, dtype=np.int64), np.column_stack([empty, *(columns[place] for place in places)])


def _changed(array: NDArray[Any], start: int, values: Sequence[Any]) -> list[tuple[int, Words]]:
    """Places in an array that some line of values changes in any bit, and the words of all lines there."""
    old = array.reshape(-1)[start : start + len(values[0])]
    new = np.array(values, dtype=old.dtype)
    bits = np.dtype(f"u{old.dtype.itemsize}")
    differ = (new.view(bits) != old.view(bits)).any(axis=0)
    if differ.any() and old.dtype.itemsize != 8:
        raise Unpatched
    return [(start + int(place), new[:, place].view(np.uint64)) for place in np.flatnonzero(differ)]
