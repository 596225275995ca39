"""Stops whose restitution is zero: a little more of it lets them bounce where they are struck."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.patches import parameter_place
from clutchwork.declare.schema import specs
from clutchwork.gradients.grazing import AT, IMPACT
from clutchwork.model.parts import is_stop

if TYPE_CHECKING:
    from clutchwork.gradients.words import Chart, Slopes

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def held_fast(chart: Chart, words: Array, slopes: Slopes, events: Array) -> Iterator[tuple[float, str, Mask]]:
    """Since when [s] such a stop has been struck, what is said of it, and numbers that would let it bounce."""
    first, count = chart.words_in("params")
    struck = events[events[:, AT["cause"]] == IMPACT]
    if not len(struck) or not slopes.touch(first, count):
        return
    system = chart.assembled.system
    for number, contact in enumerate(system.contacts):
        own = struck[struck[:, AT["contact"]] == number, AT["time"]]
        if not len(own) or not is_stop(contact):
            continue
        for item, _ in specs(type(contact), "param"):
            place = first + parameter_place(system.numbered, contact, item.name)
            if item.name.endswith("restitution") and words[place] == 0.0:
                numbers: Mask = slopes.of(np.array([place]))[0] != 0.0
                if numbers.any():
                    what = f"{contact.name} is struck at {own[0]:.9g} s with {item.name} 0"
                    yield float(own[0]), f"{what}, and bounces for a little more", numbers
