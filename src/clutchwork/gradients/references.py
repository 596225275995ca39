"""What a signal is measured from that presses something: zero, and the number of its owner below which it does not."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.patches import parameter_place
from clutchwork.base.memoize import memoize
from clutchwork.declare.schema import inputs

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Component
    from clutchwork.gradients.words import Chart, Slopes

Array = NDArray[np.float64]


class Reference(NamedTuple):
    """A value at which a signal begins to act."""

    value: float
    slopes: Array  # of it by the numbers
    words: str  # what is said of a signal that has this value


class TakenOff(NamedTuple):
    """Where such a number stands: the signal that it is taken off, -1 of a state, its place among all parameters."""

    number: int
    place: int
    sign: float
    name: str


def references(chart: Chart, words: Array, slopes: Slopes, number: int) -> Iterator[Reference]:
    """Values at which a signal begins to act: zero, and what its owner takes off it."""
    zero, first = Reference(0.0, np.zeros(slopes.matrix.shape[1]), "0"), chart.words_in("params")[0]
    found = dict[float, Reference]()
    for one in taken_off(chart.assembled.system):
        if one.number == number:
            word = first + one.place
            value = one.sign * float(words[word]) + 0.0
            found[value] = Reference(value, one.sign * slopes.of(np.array([word]))[0], f"{value:g}, as {one.name},")
    yield found.pop(0.0, zero)._replace(words="0")
    yield from found.values()


def touched(chart: Chart, slopes: Slopes) -> bool:
    """Whether any number moves one of them."""
    first, count = chart.words_in("params")
    return slopes.touch(first, count) and any(
        slopes.touch(first + one.place, 1) for one in taken_off(chart.assembled.system)
    )


@memoize
def taken_off(system: System) -> tuple[TakenOff, ...]:
    """Numbers that are taken off signals."""
    known = {item.name: number for number, item in enumerate(system.inputs)}
    return tuple(one for part in (*system.contacts, *system.processes) for one in _of(system, part, known))


def _of(system: System, part: Component, known: dict[str, int]) -> Iterator[TakenOff]:
    signal, number = part.takes_off()
    for names, _ in inputs(type(part)) if number else ():
        if signal in names:
            sign = -1.0 if getattr(part, "reversed", False) else 1.0
            place = parameter_place(system.numbered, part, number)
            mine = [known[one] for one in (f"{part.name}.{name}" for name in names) if one in known]
            yield TakenOff(mine[0] if mine else -1, place, sign, f"{part.name}.{number}")
