"""Words that are assembled from numbers: fractions of inertias and ratios, scales, points of curves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError
from clutchwork.gradients.finite_differences import Bent, Rebuilt, slope
from clutchwork.gradients.system_words import WordStructure, finite, made, words_made, words_of
from clutchwork.results.gradient import NoGradient

if TYPE_CHECKING:
    from clutchwork.assembly.provenance import Parameter
    from clutchwork.assembly.system import System
    from clutchwork.gradients.parameters import Tunable

Array = NDArray[np.float64]

# Systems that are remembered
MOST_KEPT = 8
# key of derivatives that hold everywhere
STRAIGHT = b"straight"


@dataclass(frozen=True, eq=False)
class Assembled:
    """Words that follow from some numbers by assembling the driveline, and their derivatives.

    Those by inertias, of which words are sums, are exact. The others are differences of eighth order, whose rounding
    error is some 1e-13; where the words are a plane over these numbers they are found once.
    """

    system: System
    structure: WordStructure
    parameters: tuple[Tunable, ...]
    start: Array  # their values in the System
    sums: dict[int, Parameter]  # those that the words are sums of, by their number
    _systems: dict[bytes, System] = field(default_factory=dict, repr=False)
    _known: dict[bytes, Array] = field(default_factory=dict, repr=False)  # derivatives by the others, by their values

    def words(self, x: Array) -> Array | None:
        """The words for values of the numbers; None where the structure is another one there."""
        if np.array_equal(x, self.start):
            return self.structure.words
        found = words_of(self._system(x))
        return found if self.structure.is_that_of(found) else None

    def _system(self, x: Array) -> System:
        if np.array_equal(x, self.start):
            return self.system
        key, known = x.tobytes(), self._systems
        if key not in known:
            if len(known) >= MOST_KEPT:
                known.clear()
            known[key] = made(self.system, self.parameters, x)
        return known[key]

    def slopes(self, x: Array) -> Array:
        """Derivatives of all words, a column for each number; NoGradient where there is none."""
        columns, others = np.zeros((len(self.structure.words), len(x))), self._others
        for number, one in self.sums.items():
            columns[one.words, number] = one.derivative
        key = x[others].tobytes()
        if others and STRAIGHT not in self._known and key not in self._known:
            if len(self._known) >= MOST_KEPT:
                self._known.clear()
            found, is_plane = self._differences(x)
            self._known[STRAIGHT if is_plane else key] = found
        if others:
            columns[:, others] = self._known[STRAIGHT if STRAIGHT in self._known else key]
        return columns

    @cached_property
    def _others(self) -> list[int]:
        return [number for number in range(len(self.start)) if number not in self.sums]

    def _differences(self, x: Array) -> tuple[Array, bool]:
        """Derivatives at a point by the numbers that words are no sums of, and whether they are those of all points."""
        there = partial(self._beside, self._pinned(x))
        here, columns, problems, straight = there(x), list[Array](), list[str](), True
        for number in self._others:
            one = self.parameters[number]
            size = max(abs(float(x[number])), one.scale if one.places else 0.0) or 1.0
            try:
                found = slope(partial(_along, there, x, number), here, size, one.reach)
            except Bent as bent:
                problems.append(f"{one.name} = {x[number]:g} {one.unit}: {bent}")
                continue
            columns.append(found.value)
            straight = straight and found.straight
        if problems:
            raise NoGradient(problems)
        slopes = np.stack(columns, axis=1)
        return slopes, straight and self._is_plane(x, here, slopes, there)

    def _is_plane(self, x: Array, here: Array, slopes: Array, there: Callable[[Array], Array]) -> bool:
        """Whether two more points lie on the plane through the words at one."""
        sizes = np.where(x == 0.0, 1.0, np.abs(x)) * (1.0 + 0.3 * np.cos(np.arange(len(x))))
        for share in (0.03, -0.02):
            step = share * np.minimum(sizes, [one.reach for one in self.parameters])
            step[list(self.sums)] = 0.0
            try:
                rise = there(x + step) - here
            except (ModelError, Rebuilt):
                return False
            own = step[self._others]
            if np.any(np.abs(rise - slopes @ own) > 1e-12 * (np.abs(slopes) @ np.abs(own)) + 4e-15 * np.abs(here)):
                return False
        return True

    def _beside(self, system: System, x: Array) -> Array:
        words = words_made(system, self.parameters, x)
        if not self.structure.is_that_of(words):
            raise Rebuilt
        return finite(words)

    def _pinned(self, x: Array) -> System:
        """The System at a point, with its independent speeds asked for, so that values beside do not choose others."""
        return self._pinned_start if np.array_equal(x, self.start) else self._with_speeds(x)

    @cached_property
    def _pinned_start(self) -> System:
        return self._with_speeds(self.start)

    def _with_speeds(self, x: Array) -> System:
        system = self._system(x)
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
