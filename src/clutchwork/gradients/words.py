"""From numbers of a driveline to words of its System: the words for any values, and their derivatives.

A number that is a word by itself, such as a gain, and a table that is a signal are written into the bytes of one
System. What goes into words together with other numbers, as inertias and ratios do, is assembled.
docs/theory/gradients.md (10) and (11)
"""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.changes import is_right, is_right_law, ruled
from clutchwork.base.classes import dataclass
from clutchwork.declare.node import Component, Law
from clutchwork.gradients.system_words import made, words_of
from clutchwork.gradients.word_map import Chart, Slopes
from clutchwork.model.changes import named, renewed, target
from clutchwork.model.model import Model

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.parameters import Tunable

Array = NDArray[np.float64]

# structures of a driveline that are remembered
MOST_CHARTS = 8


@dataclass(frozen=True, eq=False)
class Words:
    """The words of a System as functions of numbers."""

    system: System
    parameters: tuple[Tunable, ...]
    _charts: list[Chart] = field(default_factory=list, repr=False)

    def at(self, x: Array) -> tuple[Chart, Array]:
        """The words at a point, and what they follow from there; ModelError for values that the driveline refuses."""
        self._check(x)
        for chart in self._charts:
            found = chart.words(x)
            if found is not None:
                return chart, found
        system = self.assembled(x)
        chart = Chart.of(system, self.parameters, x)
        self._charts[:] = [chart, *self._charts[: MOST_CHARTS - 1]]
        return chart, words_of(system)

    def bytes_at(self, x: Array) -> bytes:
        """The bytes of the System at a point."""
        return self.at(x)[1].tobytes()

    def slopes_at(self, x: Array) -> Slopes:
        """Derivatives of the words at a point; NoGradient where a number has none."""
        return self.at(x)[0].slopes(x)

    def assembled(self, x: Array) -> System:
        """The System at a point, with its names."""
        return made(self.system, self.parameters, x)

    def _check(self, x: Array) -> None:
        """Refuse what a driveline with these values refuses, in its words."""
        lower, upper = self._bounds
        if (x < lower).any() or (x > upper).any() or not all(self._fits(x, *rule) for rule in self._rules):
            self.assembled(x)

    @cached_property
    def _bounds(self) -> tuple[Array, Array]:
        return np.array([one.lower for one in self.parameters]), np.array([one.upper for one in self.parameters])

    @cached_property
    def _rules(self) -> list[tuple[Component | Law, list[tuple[tuple[str, ...], int]]]]:
        """Elements and laws with numbers between which there may be rules, as between two coefficients."""
        owners, known = named(self.system.source or Model()), dict[str, tuple[Component, dict[tuple[str, ...], int]]]()
        for number, one in enumerate(self.parameters):
            aim = target(owners, one.field)
            if aim is not None and isinstance(aim.owner, Component) and not one.places:
                known.setdefault(aim.owner.name, (aim.owner, {}))[1][aim.path] = number
        found = list[Any]()
        for owner, paths in known.values():
            thing = ruled(owner, [*paths])
            if isinstance(thing, Law):
                found.append((thing, [(path[1:], number) for path, number in paths.items() if len(path) > 1]))
            elif thing is not None:
                found.append((thing, list(paths.items())))
        return found

    @staticmethod
    def _fits(x: Array, thing: Component | Law, paths: list[tuple[tuple[str, ...], int]]) -> bool:
        new = renewed(thing, [(path, float(x[number])) for path, number in paths])
        return is_right_law(new) if isinstance(thing, Law) else is_right(thing, new)
