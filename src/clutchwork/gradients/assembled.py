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
from clutchwork.gradients.system_words import WordStructure, finite, made, with_masses, words_made, words_of
from clutchwork.results.gradient import NoGradient

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.parameters import Tunable

Array = NDArray[np.float64]

# Systems that are remembered
MOST_KEPT = 8
# key of derivatives that hold everywhere
STRAIGHT = b"straight"


@dataclass(frozen=True, eq=False)
class Assembled:
    """Words that follow from some numbers by assembling the driveline, and their derivatives by differences.

    Derivatives are differences of eighth order, whose rounding error is some 1e-13. Where the words are a plane over
    the numbers that go into them, as they are over inertias, they are found once.
    """

    system: System
    structure: WordStructure
    parameters: tuple[Tunable, ...]
    start: Array  # their values in the System
    _systems: dict[bytes, System] = field(default_factory=dict, repr=False)
    _known: dict[tuple[int, bytes], Array] = field(default_factory=dict, repr=False)  # derivatives, by group and values

    def words(self, x: Array) -> Array | None:
        """The words for values of the numbers; None where the structure is another one there."""
        if (x == self.start).all():
            return self.structure.words
        quick = with_masses(self.system, self.parameters, x)
        found = words_of(self._system(x)) if quick is None else quick
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
        columns, problems, there = np.zeros((len(self.structure.words), len(x))), list[str](), None
        for group in self._groups:
            key = x[group].tobytes()
            known = self._known.get((group[0], STRAIGHT), self._known.get((group[0], key)))
            if known is None:
                there = there or partial(self._beside, self._pinned(x))
                try:
                    known, is_plane = self._differences(x, group, there)
                except NoGradient as none:
                    problems += none.problems
                    continue
                self._known[group[0], STRAIGHT if is_plane else key] = known
            columns[:, group] = known
        if problems:
            raise NoGradient(problems)
        if len(self._known) > MOST_KEPT * len(self._groups):
            self._known.clear()
        return columns

    @cached_property
    def _groups(self) -> list[list[int]]:
        """Numbers that go into words together: those that touch the same words, where none is zero by chance."""
        there = partial(self._beside, self._pinned(self.start))
        sizes = np.where(self.start == 0.0, 1.0, np.abs(self.start))
        step = 1e-3 * np.minimum(sizes, [one.reach for one in self.parameters])
        for sign in (1.0, -1.0):
            try:
                base = there(self.start + sign * step)
                touched = [there(self.start + sign * step * (1.0 + self._only(n))) != base for n in range(len(step))]
            except (ModelError, Rebuilt):
                continue
            return _joined(touched)
        return [list(range(len(step)))]

    def _only(self, number: int) -> Array:
        return np.array([float(n == number) for n in range(len(self.start))])

    def _differences(self, x: Array, group: list[int], there: Callable[[Array], Array]) -> tuple[Array, bool]:
        """Derivatives by the numbers of a group at a point, and whether they are those of all points."""
        here, columns, problems, straight = there(x), list[Array](), list[str](), True
        for number in group:
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
        return slopes, straight and self._is_plane(x, group, here, slopes, there)

    def _is_plane(
        self, x: Array, group: list[int], here: Array, slopes: Array, there: Callable[[Array], Array]
    ) -> bool:
        """Whether two more points lie on the plane through the words at one."""
        sizes = np.where(x == 0.0, 1.0, np.abs(x)) * (1.0 + 0.3 * np.cos(np.arange(len(x))))
        for share in (0.03, -0.02):
            step = np.zeros(len(x))
            step[group] = share * np.minimum(sizes, [one.reach for one in self.parameters])[group]
            try:
                rise = there(x + step) - here
            except (ModelError, Rebuilt):
                return False
            own = step[group]
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


def _joined(touched: list[NDArray[np.bool_]]) -> list[list[int]]:
    """Numbers in groups, none of which touches a word of another."""
    groups = list[tuple[list[int], NDArray[np.bool_]]]()
    for number, words in enumerate(touched):
        mine = [group for group in groups if np.any(group[1] & words)]
        members = [n for group in mine for n in group[0]]
        groups = [group for group in groups if not np.any(group[1] & words)]
        groups.append(([*members, number], np.logical_or.reduce([words, *(group[1] for group in mine)])))
    return sorted(sorted(members) for members, _ in groups)
