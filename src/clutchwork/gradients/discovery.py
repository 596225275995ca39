"""Which words of a System numbers are by themselves: seen by moving them, one by one and then all together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.errors import ModelError
from clutchwork.gradients.parameters import Tunable
from clutchwork.gradients.system_words import WordStructure, words_made
from clutchwork.gradients.tables import TableWords
from clutchwork.model.changes import field_of, named, target

if TYPE_CHECKING:
    from collections.abc import Iterator

    from clutchwork.assembly.system import System

Array = NDArray[np.float64]
Places = NDArray[np.int64]

# by so much of their scale numbers are moved; those at a bound go to one side alone
PROBES = (1e-3, -1.7e-3, 2.3e-3, -2.9e-3)


def identity(system: System, structure: WordStructure, one: Tunable, value: float) -> Places | None:
    """The words that a number is, None where it is more than that."""
    if one.places or _is_shared(system, one):
        return None
    found = list[Places]()
    for share in PROBES:
        there = value + share * one.scale
        try:
            words = words_made(system, [one], np.array([there]))
        except ModelError:
            continue
        places = structure.changed(words) if structure.is_that_of(words) else np.zeros(0, dtype=np.int64)
        if not len(places) or np.any(words[places] != there):
            return None
        found.append(places)
        if len(found) == 2:
            return places if np.array_equal(found[0], places) else None
    return None


def _is_shared(system: System, one: Tunable) -> bool:
    """Whether the assembly makes something of a number together with others, such as the larger of two."""
    aim = target(named(system.source), one.field) if system.source else None
    return aim is None or field_of(aim)[1].what == "option" or aim.path[-1] == "band"


def tables(system: System, structure: WordStructure, parameters: Sequence[Tunable]) -> Iterator[TableWords]:
    """Tables of numbers that are signals of their own."""
    fields = dict.fromkeys(one.field for one in parameters if one.places)
    for name in fields:
        free = [(number, one) for number, one in enumerate(parameters) if one.places and one.field == name]
        beside = _beside(system, name)
        found = TableWords.of(system, beside, structure.layout, name, free) if beside else None
        if found is not None:
            yield found


def _beside(system: System, name: str) -> System | None:
    """A System whose table of that name has perturbed values; None where the name is not that of a table of pairs."""
    aim = target(named(system.source), name) if system.source else None
    points: Any = field_of(aim)[0] if aim else ()
    if not points or not all(hasattr(point, "__len__") and len(point) == 2 for point in points):
        return None
    size = max(abs(float(y)) for _, y in points) or 1.0
    for share in PROBES:
        try:
            return system.changed(
                {name: [[x, y + share * size * (1 + i / len(points))] for i, (x, y) in enumerate(points)]}
            )
        except ModelError:
            continue
    return None


def together(system: System, parameters: Sequence[Tunable], x: Array, fixed: Sequence[int]) -> tuple[Array, Array]:
    """A point at which all numbers but those that are fixed are others, and the words there."""
    moves = np.array([_room(one, value) for one, value in zip(parameters, x.tolist(), strict=True)])
    moves[list(fixed)] = 0.0
    for share in PROBES:
        try:
            there = x + share * moves
            return there, words_made(system, parameters, there)
        except ModelError:
            continue
    return x, np.zeros(0)


def _room(one: Tunable, value: float) -> float:
    """By how much a number may move without another structure: a knot at 0 stays there."""
    return min(one.scale, one.reach) * (value != 0.0) if np.isfinite(one.reach) else one.scale
