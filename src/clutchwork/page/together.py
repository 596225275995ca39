"""Whether two sliders depend on each other: both at once make other words than the page would put together."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import ModelError
from clutchwork.page.slider import Bytes, Slider, Words

if TYPE_CHECKING:
    from collections.abc import Mapping

    from clutchwork.assembly.system import System


def made(system: System, changes: Mapping[str, float]) -> tuple[System | None, str]:
    """The System with other numbers, or why there is none."""
    try:
        return system.changed(changes), ""
    except ModelError as error:
        return None, str(error).strip().splitlines()[-1].strip()


def words_of(system: System, bytes_of: Bytes) -> Words:
    """The words of a System, as the page has them."""
    return np.frombuffer(bytes_of(system), dtype=np.uint64)


def refused(system: System, one: Slider, other: Slider) -> bool:
    """Whether one decides where the other has a driveline, as a static and a kinetic coefficient do."""
    places = [*product(one.ends, other.ends), *zip(_few(one), _few(other), strict=True)]
    return any(_refused(system, one, other, *at) for at in places)


def _refused(system: System, one: Slider, other: Slider, first: float, second: float) -> bool:
    changes = one.changes(first), other.changes(second)
    alone = [why for own in changes if (why := made(system, own)[1])]
    return bool(made(system, changes[0] | changes[1])[1]) != bool(alone)


def dependent(system: System, one: Slider, other: Slider, bytes_of: Bytes) -> bool:
    """Whether they change the same words, or make other words at once than one after the other."""
    if set(one.places.tolist()) & set(other.places.tolist()):
        return True
    # a product of which one factor is zero at the start is seen only where neither is there
    return any(_differs(system, one, other, *at, bytes_of) for at in zip(_few(one), _few(other), strict=True))


def _few(slider: Slider) -> tuple[float, float]:
    """Two of its values, neither of them its start."""
    turned = slider.values[slider.values != slider.start]
    return float(turned[-1]), float(turned[len(turned) // 3])


def _differs(system: System, one: Slider, other: Slider, first: float, second: float, bytes_of: Bytes) -> bool:
    found, _ = made(system, one.changes(first) | other.changes(second))
    if found is None:
        return False
    words = words_of(system, bytes_of).copy()
    one.turned(words, first)
    other.turned(words, second)
    return not np.array_equal(words, words_of(found, bytes_of))
