"""What a System holds besides numbers: its inputs, links and gears by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.declare.node import Component, Signal, ThermalNode
from clutchwork.declare.schema import Spec

TYPES: dict[str, np.dtype[Any]] = {"f8": np.dtype("<f8"), "i4": np.dtype("<i4")}
Array = NDArray[Any]


@dataclass(frozen=True)
class Input:
    """One signal of a System: "c1.pressure", its unit, and what drives it."""

    name: str
    unit: str
    signal: Signal
    spec: Spec  # what it may be
    owner: Component | ThermalNode  # whose it is
    quantity: str  # its name there, "friction.load"
    given: bool = True  # false: an unused feature, which stays at its value


@dataclass(frozen=True)
class Link:
    """An input that another component gives: "c1.pressure" from an actuator."""

    name: str
    unit: str
    sort: str  # "input" (the temperature of an ambient) or "shared"
    number: int


@dataclass(frozen=True)
class Gearing:
    """One rigid row of a gear: sum over its ports of coefficient * speed = 0."""

    gear: Component
    ports: Mapping[str, tuple[int, float]]  # port -> (node or -1 for the housing, coefficient)


def frozen(arrays: Mapping[str, Array]) -> Mapping[str, Array]:
    """The arrays, no longer writeable."""
    for array in arrays.values():
        array.flags.writeable = False
    return MappingProxyType(dict(arrays))
