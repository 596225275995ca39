"""From numbers of a driveline to words of its System: the words for any values, and their derivatives.

docs/theory/gradients.md (10) and (11)
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.changes import is_right, is_right_law, owners_of, ruled
from clutchwork.assembly.provenance import PROBES, SystemParameter, parameter
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError
from clutchwork.declare.node import Component, Law, Node
from clutchwork.gradients.assembled import Assembled, WordStructure, made, words_of
from clutchwork.gradients.tables import TableWords
from clutchwork.model.changes import Target, field_of, renewed, target

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.parameters import Tunable

Array = NDArray[np.float64]
Places = NDArray[np.int64]

# an element or a law, and its numbers by the fields that lead to them
Rule = tuple[Component | Law, list[tuple[tuple[str, ...], int]]]

# fields of shafts and masses that say where they are
PLACES = ("angle", "position")
# structures of a driveline that are remembered
MOST_CHARTS = 8


class Slopes(NamedTuple):
    """Words that change with numbers, and their derivatives: a line for each word, a column for each number."""

    places: Places
    matrix: Array

    def within(self, first: int, count: int) -> slice:
        """Lines of the words that change among some that follow each other."""
        return slice(bisect_left(self.places, first), bisect_left(self.places, first + count))

    def touch(self, first: int, count: int) -> bool:
        """Whether any of them changes."""
        return bisect_left(self.places, first) < bisect_left(self.places, first + count)

    def of(self, words: Places) -> Array:
        """Derivatives of words: a line for each."""
        made = np.zeros((len(words), self.matrix.shape[1]))
        at = np.searchsorted(self.places, words)
        there = np.isin(words, self.places)
        made[there] = self.matrix[at[there]]
        return made


@dataclass(frozen=True, eq=False)
class Chart:
    """How the words of one structure of a driveline follow from numbers."""

    fixed: dict[int, SystemParameter]  # numbers that words are, or are sums of: derivatives are the same everywhere
    written: dict[int, Places]  # those of them that are words, which need not be assembled
    tables: tuple[TableWords, ...]
    assembled: Assembled  # all others

    @property
    def bound(self) -> tuple[int, ...]:
        """Numbers that words are assembled from."""
        return self.assembled.numbers

    @cached_property
    def beside(self) -> list[int]:
        """Numbers that are neither words nor in a table."""
        inside = {*self.written, *(number for table in self.tables for number in table.numbers.tolist())}
        return [number for number in range(len(self.assembled.start)) if number not in inside]

    def words_in(self, name: str) -> tuple[int, int]:
        """The first word of an array of a System, and how many there are."""
        return self._arrays[name]

    @cached_property
    def _arrays(self) -> dict[str, tuple[int, int]]:
        system = self.assembled.system
        return {name: (system.starts[name] // 8, array.size) for name, array in system.arrays.items()}

    def stays(self, *names: str) -> bool:
        """Whether it is known once for all points that nothing in these arrays changes."""
        return self._still.issuperset(names)

    @cached_property
    def _still(self) -> frozenset[str]:
        same = self._same
        return frozenset(name for name, part in self._arrays.items() if same is not None and not same.touch(*part))

    @classmethod
    def of(cls, system: System, parameters: tuple[Tunable, ...], x: Array) -> Chart:
        """Look at how the words of a System, which has these values, follow from them."""
        structure = WordStructure.of(system)
        known, there = _known(system, structure, parameters, x)
        fixed, tables = dict[int, SystemParameter](), list[TableWords]()
        for name, own in known.items():
            free = [(number, one) for number, one in enumerate(parameters) if one.field == name]
            # what goes into a word together with others is assembled, but sums stand beside each other
            beside = [one.words for one in known.values() if one is not own and not (own.is_sum and one.is_sum)]
            if np.isin(own.words, np.concatenate([own.words[:0], *beside])).any():
                continue
            if own.derivative is not None and _is_same(own, parameter(system, name)):
                fixed[free[0][0]] = own
            elif own.is_signal and free[0][1].places:
                found = TableWords.of(system, own.inputs, free)
                tables += [found] if found else []
        used = {*fixed, *(number for table in tables for number in table.numbers.tolist())}
        rest = tuple(number for number in range(len(x)) if number not in used)
        made_of = Assembled(system, structure, parameters, x, rest)
        together = _beside_curves(parameters, rest)
        words = {number: one.words for number, one in fixed.items() if one.is_word and number not in together}
        alone = [number for number in words if _is_free(system, fixed[number], parameters[number])]
        # an angle must fit the ends of any stop, which may be others too
        written = {} if _moves_places(system, parameters) else {number: words[number] for number in alone}
        whole = cls(fixed, written, tuple(tables), made_of)
        # numbers that fit together alone are assembled
        return whole if there is None or whole.gives(*there) else replace(whole, written={})

    def gives(self, system: System, x: Array) -> bool:
        """Whether the words at a point are those of its System."""
        words = self.words(x)
        return words is not None and words.tobytes() == system.to_bytes()

    def words(self, x: Array) -> Array | None:
        """The words at a point; None where the structure is another one there."""
        rest, known = self.beside, self.assembled
        try:
            others = [known.parameters[number] for number in rest]
            system = made(known.system, others, x[rest]) if others else known.system
        except ModelError:
            return None
        words = words_of(system).copy()
        # other inertias may make other speeds independent
        if system is not known.system and not (
            known.structure.is_that_of(words) and system.independent == known.system.independent
        ):
            return None
        if not self._follows(x):
            return None
        for number, places in self.written.items():
            words[places] = x[number]
        for table in self.tables:
            table.write(words, x)
        return words

    def _follows(self, x: Array) -> bool:
        """Whether the words at a point follow alike: at zero a number may be at a kink."""
        alike = all(_sign(float(x[number])) == sign for number, sign in self._signs)
        return alike and all(table.holds(x) for table in self.tables)

    @cached_property
    def _signs(self) -> list[tuple[int, int]]:
        return [(number, _sign(float(self.assembled.start[number]))) for number in self.fixed]

    def slopes(self, x: Array) -> Slopes:
        """Derivatives of the words at a point; NoGradient where there is none."""
        return self._same or self._slopes(x)

    @cached_property
    def _same(self) -> Slopes | None:
        """Derivatives that are the same everywhere: nothing is assembled, and no knot moves in time."""
        free = self.bound or any(table.moves_times for table in self.tables)
        return None if free else self._slopes(self.assembled.start)

    def _slopes(self, x: Array) -> Slopes:
        more = self.assembled.slopes(x)
        known, own = np.flatnonzero(more.any(axis=1)), (part.words for part in self.fixed.values())
        places = np.unique(np.concatenate([known, *own, *(table.places for table in self.tables)]))
        matrix = np.zeros((len(places), len(x)))
        for number, part in self.fixed.items():
            matrix[np.searchsorted(places, part.words), number] = part.derivative
        for table in self.tables:
            matrix[np.ix_(np.searchsorted(places, table.places), table.numbers)] = table.slopes(x)
        matrix[np.searchsorted(places, known)[:, None], list(self.bound)] = more[known]
        return Slopes(places, matrix)


@dataclass(frozen=True, eq=False)
class Words:
    """The words of a System as functions of numbers."""

    system: System
    parameters: tuple[Tunable, ...]
    _charts: list[Chart] = field(default_factory=list, repr=False)
    _last: list[tuple[bytes, tuple[Chart, Array]]] = field(default_factory=list, repr=False)

    def at(self, x: Array) -> tuple[Chart, Array]:
        """The words at a point, and how they follow from it; ModelError for values that the driveline refuses."""
        key = x.tobytes()
        # a gradient asks several times at one point
        for known, found in self._last[:1]:
            if known == key:
                return found
        found = self._at(x)
        found[1].setflags(write=False)
        self._last[:] = [(key, found)]
        return found

    def _at(self, x: Array) -> tuple[Chart, Array]:
        self._check(x)
        for chart in self._charts:
            words = chart.words(x)
            if words is not None:
                return chart, words
        system = self.assembled(x)
        chart = Chart.of(system, self.parameters, x)
        self._charts[:] = [chart, *self._charts[: MOST_CHARTS - 1]]
        return chart, words_of(system)

    def _check(self, x: Array) -> None:
        """Refuse what a driveline with these values refuses, in its words."""
        within = all(lower <= value <= upper for value, (lower, upper) in zip(x.tolist(), self._bounds, strict=True))
        if not within or not all(_fits(x, *rule) for rule in self._rules):
            self.assembled(x)

    @cached_property
    def _pressing(self) -> list[int]:
        """Numbers of signals that press a contact, which must be above zero somewhere."""
        aims = [target(owners_of(self.system), one.field) for one in self.parameters]
        fields = [None if aim is None else field_of(Target(aim.owner, aim.path[:1]))[1] for aim in aims]
        return [number for number, spec in enumerate(fields) if spec is not None and spec.presses]

    @cached_property
    def _rules(self) -> list[Rule]:
        """Elements and laws with numbers between which there may be rules, as between two coefficients."""
        owners, known = owners_of(self.system), dict[str, tuple[Component, dict[tuple[str, ...], int]]]()
        for number, one in enumerate(self.parameters):
            aim = target(owners, one.field)
            if aim is not None and isinstance(aim.owner, Component) and not one.places:
                known.setdefault(aim.owner.name, (aim.owner, {}))[1][aim.path] = number
        found = list[Rule]()
        for owner, paths in known.values():
            thing = ruled(owner, [*paths])
            cut = int(isinstance(thing, Law))
            if thing is not None:
                found.append((thing, [(path[cut:], number) for path, number in paths.items() if len(path) > cut]))
        return found

    @cached_property
    def _bounds(self) -> list[tuple[float, float]]:
        found = [(one.lower, one.upper) for one in self.parameters]
        for number in self._pressing:
            found[number] = max(found[number][0], 0.0), found[number][1]
        return found

    def bytes_at(self, x: Array) -> bytes:
        """The bytes of the System at a point."""
        return self.at(x)[1].tobytes()

    def slopes_at(self, x: Array) -> Slopes:
        """Derivatives of the words at a point; NoGradient where a number has none."""
        return self.at(x)[0].slopes(x)

    def assembled(self, x: Array) -> System:
        """The System at a point."""
        return made(self.system, self.parameters, x)


def _beside_curves(parameters: Sequence[Tunable], assembled: Sequence[int]) -> set[int]:
    """Numbers of elements of which points of a curve are assembled: rules hold between the new ones of both."""
    owners = [one.field.partition(".")[0] for one in parameters]
    curved = {owners[number] for number in assembled if parameters[number].places}
    return {number for number, owner in enumerate(owners) if owner in curved}


def _moves_places(system: System, parameters: Sequence[Tunable]) -> bool:
    """Whether angles or positions of shafts and masses are among the numbers."""
    aims = [target(owners_of(system), one.field) for one in parameters]
    return any(aim is not None and isinstance(aim.owner, Node) and aim.path[0] in PLACES for aim in aims)


def _is_free(system: System, own: SystemParameter, free: Tunable) -> bool:
    """Whether a number that is a word is one at any value: speeds of shafts may contradict others."""
    aim = target(owners_of(system), free.field)
    if aim is None or not isinstance(aim.owner, Node):
        return True
    # far beyond what is forgiven of speeds that contradict one another
    far = 1.0 + max(abs(node.speed or 0.0) for node in system.nodes)
    return own.is_word_at(own.value + far) and own.is_word_at(own.value - far)


def _sign(number: float) -> int:
    return (number > 0.0) - (number < 0.0)


def _fits(x: Array, thing: Component | Law, paths: Sequence[tuple[tuple[str, ...], int]]) -> bool:
    new = renewed(thing, [(path, float(x[number])) for path, number in paths])
    return is_right_law(new) if isinstance(thing, Law) else is_right(thing, new)


def _known(
    system: System, structure: WordStructure, parameters: Sequence[Tunable], x: Array
) -> tuple[dict[str, SystemParameter], tuple[System, Array] | None]:
    """What numbers reach where all are others, as a product of which one factor is zero depends on both; that point."""
    moves = np.array([_room(one, value) for one, value in zip(parameters, x.tolist(), strict=True)])
    beside = _beside(system, structure, parameters, x, moves)
    if beside is None:
        # numbers that make another structure by themselves stay
        moves *= [bool(parameter(system, one.field).words.size) for one in parameters]
        beside = _beside(system, structure, parameters, x, moves)
    return {one.field: parameter(beside[0] if beside else system, one.field) for one in parameters}, beside


def _is_same(one: SystemParameter, other: SystemParameter) -> bool:
    """Whether a number, which may be at a kink in one of two Systems, reaches the same words in both."""
    return other.derivative is not None and np.array_equal(one.words, other.words)


def _beside(
    system: System, structure: WordStructure, parameters: Sequence[Tunable], x: Array, moves: Array
) -> tuple[System, Array] | None:
    """The System with other numbers, and these; None where it has another structure."""
    for share in PROBES:
        with suppress(ModelError):
            there = x + share * moves
            found = made(system, parameters, there)
            return (found, there) if structure.is_that_of(words_of(found)) else None
    return None


def _room(one: Tunable, value: float) -> float:
    """By how much a number may move without another structure: a knot at 0 stays there."""
    return min(one.scale, one.reach) * (value != 0.0) if np.isfinite(one.reach) else one.scale
