"""The variables of an FMU: what is set from outside, what may be changed, what is computed."""

from __future__ import annotations

from dataclasses import field
from enum import IntEnum
from math import inf
from typing import NamedTuple

from clutchwork.base import dataclass
from clutchwork.results.forms import Form


class VariableKind(IntEnum):
    """What a variable is, by the number that the library knows it by."""

    TIME = 0
    INPUT = 1
    SLOPE = 2
    TUNABLE = 3
    FIXED = 4
    SIGNAL = 5
    MODE = 6
    RATE = 7
    MARGIN = 8


class Place(NamedTuple):
    """A number that follows a value along a straight line; a slope that is not a number: it is the value itself."""

    number: int
    slope: float


class NumberThatFollows(NamedTuple):
    """A number of an output that follows a parameter or its reciprocal: its form among all, and where in that."""

    form: int
    term: int
    side: int
    share: int  # -1: the offset
    slope: float
    is_reciprocal: bool


@dataclass(frozen=True)
class FmuVariable:
    """One variable; its value reference is its place among all."""

    name: str
    kind: VariableKind
    unit: str
    start: float = 0.0
    bounds: tuple[float, float] = (-inf, inf)
    about: str = ""
    path: str = ""  # of a parameter in the driveline
    far: tuple[float, ...] = ()  # other values that a parameter may have
    reaches_forms: bool = False  # whether outputs may be computed from it
    of: int = -1  # value reference of the input of a slope; number of the state of a rate, or of an event indicator
    inputs: tuple[int, ...] = ()  # numbers in the core
    words: tuple[Place, ...] = ()  # of the bytes of the System
    params: tuple[Place, ...] = ()  # of the pool of parameters
    forms: tuple[NumberThatFollows, ...] = ()  # of outputs, which follow a parameter
    form: Form | None = field(default=None, repr=False)
    follows_states: bool = False  # an output that no input moves at once
    state: int = -1  # number of the continuous state that it is
    nominal: float = 0.0  # its size, of a continuous state
    hidden: bool = False  # neither input nor output


class LeftOut(NamedTuple):
    """A parameter that the FMU does not have, and why."""

    name: str
    why: str
