"""Words that are assembled from numbers: fractions of inertias and ratios, scales, points of curves."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.changes import owners_of
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError, ModelWarning
from clutchwork.base.memoize import memoize
from clutchwork.base.quote import measured
from clutchwork.declare.layout import FIELDS
from clutchwork.declare.node import Node
from clutchwork.gradients.finite_differences import ROUND_OFF, Bent, Rebuilt, slope
from clutchwork.gradients.parameters import Tunable, changes
from clutchwork.model.changes import target
from clutchwork.results.gradient import NoGradient

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[np.float64]
Places = NDArray[np.intp]

# points that are remembered
MOST_KEPT = 8
# numbers of a piece of a signal, and which of them are amplitudes and phases of its waves
PIECE, AMPLITUDES, PHASES = 12, [4, 8], [6, 10]
# words that are sums of fractions, of which small ones may be what is left of large ones
SUMS = ("basis_value", "mass_value", "element_rate_value", "contact_rate_value", "initial_speed")
# key of derivatives that hold everywhere
STRAIGHT = b"straight"


def words_of(system: System) -> Array:
    """The bytes of a System as numbers."""
    return np.frombuffer(system.to_bytes(), dtype=np.float64)


def made(system: System, parameters: Sequence[Tunable], x: Array) -> System:
    """A System with other values; ModelError where the driveline refuses them."""
    with warnings.catch_warnings():
        # what is rarely wanted was said of the driveline
        warnings.simplefilter("ignore", ModelWarning)
        return system.changed(changes(system, parameters, x))


@memoize
def turning(system: System) -> tuple[Places, Array]:
    """Words that start again, as the angle of a cam at the start and the phase of a wave do, and after how much."""
    first, number = system.starts["initial_state"] // 8, 0
    coefficients = system.starts["segment_coef"] // 8 + np.arange(system.arrays["segment_coef"].size).reshape(-1, PIECE)
    places = coefficients[:, PHASES].ravel().tolist()
    turns = [2.0 * np.pi] * len(places)
    for element in system.elements:
        begin, kind = first + int(system.arrays["element_state"][number]), type(element)
        own = [(begin + place, state.turn) for place, state in enumerate(kind.states) if state.turn]
        places += [place for place, _ in own]
        turns += [turn for _, turn in own]
        number += max(1, len(kind.ways))
    return np.array(places, dtype=np.intp), np.array(turns)


def is_start_speed(system: System, one: Tunable) -> bool:
    """Whether a number is the speed of a shaft at the start, which may contradict others."""
    aim = target(owners_of(system), one.field)
    return aim is not None and isinstance(aim.owner, Node) and aim.path == ("speed",)


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
        places, known = self._fixed
        return len(words) == len(self.words) and np.array_equal(words.view(np.int64)[places], known)

    @cached_property
    def _fixed(self) -> tuple[Places, NDArray[np.int64]]:
        # words that are not numbers
        places = np.flatnonzero(~self.is_number)
        return places, self.words.view(np.int64)[places]


@dataclass(frozen=True, eq=False)
class Assembled:
    """Words that follow from some numbers by assembling the driveline, and their derivatives.

    Derivatives are differences of eighth order, whose rounding error is some 1e-13. Where the words are a plane over
    these numbers they are found once.
    """

    system: System
    structure: WordStructure
    parameters: tuple[Tunable, ...]
    start: Array  # their values in the System
    numbers: tuple[int, ...]  # those that words are assembled from
    _known: dict[bytes, Array] = field(default_factory=dict, repr=False)  # derivatives by these, by their values

    def slopes(self, x: Array) -> Array:
        """Derivatives of all words, a column for each of these numbers; NoGradient where there is none."""
        if not self.numbers:
            return np.zeros((len(self.structure.words), 0))
        key = STRAIGHT if STRAIGHT in self._known else x[list(self.numbers)].tobytes()
        if key not in self._known:
            if len(self._known) >= MOST_KEPT:
                self._known.clear()
            found, is_plane = self._differences(x)
            self._known[STRAIGHT if is_plane else key] = found
            return found
        return self._known[key]

    def _differences(self, x: Array) -> tuple[Array, bool]:
        """Derivatives at a point, and whether they are those of all points."""
        pinned, columns, problems, straight = self._pinned(x), list[Array](), list[str](), True
        here = self._beside(pinned, None, x)
        there, noise = partial(self._beside, pinned, here), self._noise(here)
        for number in self.numbers:
            one = self.parameters[number]
            own = abs(float(x[number]))
            scale = max(one.compared(own), self._speeds if is_start_speed(self.system, one) else 0.0)
            try:
                found = slope(partial(_along, there, x, number), here, own, scale, one.reach, noise)
            except Bent as bent:
                problems.append(f"{one.name} = {measured(x[number], one.unit)}: {bent}")
                continue
            columns.append(found.value)
            straight = straight and found.straight
        if problems:
            raise NoGradient(problems)
        slopes = np.stack(columns, axis=1)
        return slopes, straight and self._is_plane(x, here, slopes, there)

    @cached_property
    def _speeds(self) -> float:
        """The largest start speed that is given, of which one that others tie may miss its round-off."""
        return max((abs(node.speed or 0.0) for node in self.system.nodes), default=0.0)

    def _noise(self, words: Array) -> Array:
        """Round-off of words beyond that of their own size."""
        noise = np.zeros(len(words))
        for name in SUMS:
            first = self.system.starts[name] // 8
            own = slice(first, first + self.system.arrays[name].size)
            noise[own] = ROUND_OFF * np.abs(words[own]).max(initial=0.0)
        # a wave that begins where it is zero
        first, waves = self.system.starts["input_value"] // 8, self.system.arrays["segment_coef"].reshape(-1, PIECE)
        own = slice(first, first + self.system.arrays["input_value"].size)
        noise[own] = ROUND_OFF * np.abs(waves[:, AMPLITUDES]).max(initial=0.0)
        return noise

    def _is_plane(self, x: Array, here: Array, slopes: Array, there: Callable[[Array], Array]) -> bool:
        """Whether two more points lie on the plane through the words at one."""
        sizes = np.where(x == 0.0, 1.0, np.abs(x)) * (1.0 + 0.3 * np.cos(np.arange(len(x))))
        for share in (0.03, -0.02):
            step, own = np.zeros(len(x)), share * np.minimum(sizes, [one.reach for one in self.parameters])
            step[list(self.numbers)] = own = own[list(self.numbers)]
            try:
                rise = there(x + step) - here
            except (ModelError, Rebuilt):
                return False
            if np.any(np.abs(rise - slopes @ own) > 1e-12 * (np.abs(slopes) @ np.abs(own)) + 4e-15 * np.abs(here)):
                return False
        return True

    def _beside(self, system: System, here: Array | None, x: Array) -> Array:
        """The words at a point; what starts again after a turn goes on from where it is `here`."""
        words = words_of(made(system, self.parameters, x))
        if not self.structure.is_that_of(words):
            raise Rebuilt
        words = finite(words)
        places, turns = turning(self.system)
        if here is not None and len(places):
            words[places] -= turns * np.round((words[places] - here[places]) / turns)
        return words

    def _pinned(self, x: Array) -> System:
        """The System at a point, with its independent speeds asked for, so that values beside do not choose others."""
        system = self.system if np.array_equal(x, self.start) else made(self.system, self.parameters, x)
        asked = replace(system, wanted=system.independent)
        try:
            words = words_of(made(asked, self.parameters, x))
        except ModelError:
            # such as those without inertia, which the package chooses
            return system
        return asked if self.structure.is_that_of(words) else system


def _along(there: Callable[[Array], Array], x: Array, number: int, step: float) -> Array:
    moved = x.copy()
    moved[number] += step
    return there(moved)
