"""Other inertias in a System: the mass matrix alone changes, as long as the same speeds are independent."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, Any

from clutchwork.assembly.assemble import SpeedColumns, assembled, chosen
from clutchwork.assembly.patches import Patch, patched
from clutchwork.assembly.sparse import supports
from clutchwork.base import ModelError, dataclass
from clutchwork.base.memoize import memoize
from clutchwork.declare.node import Component
from clutchwork.declare.rational import ZERO, exact
from clutchwork.model.changes import all_names, changed_model, named, target
from clutchwork.model.findings import findings
from clutchwork.model.kinematics import order

if TYPE_CHECKING:
    from clutchwork.assembly.system_data import SystemData
    from clutchwork.model.findings import Structure
    from clutchwork.model.model import Model

# an array and a place in it, in flat order
Word = tuple[str, int]

# by one to two such shares of their size all inertias are moved, each by another one, to see that no more follows from
# them; the heavier of two by more, so that their order stays
PROBE = 1e-3


@dataclass(frozen=True, eq=False)
class Masses:
    """Inertias of the nodes of a driveline, and how its mass matrix is their sum, in fractions."""

    inertia: tuple[Fraction, ...]
    places: Mapping[str, int]  # of nodes that have some, by the name of their inertia
    wanted: tuple[int, ...]  # nodes whose speeds were asked for
    shares: Sequence[Mapping[Word, Fraction]]  # of each node: derivatives of the words of the matrix
    matrix: Mapping[Word, Fraction]

    @classmethod
    def of(cls, system: SystemData, source: Model) -> Masses | None:
        """Those of a System; None where more follows from them, as the weight of a vehicle, or other speeds."""
        found = findings(source).structure
        if found is None or any(map(judges, source.elements)):
            return None
        names = [node.name for node in found.mechanism.nodes]
        where = {id(node): place for place, node in enumerate(source.nodes) if node.inertia > 0.0}
        aims = ((name, target(named(source), name)) for name in all_names(source) if is_mass(name))
        places = {name: where[id(aim.owner)] for name, aim in aims if aim and id(aim.owner) in where}
        inertia, shares, matrix = tuple(found.mechanism.inertia), _shares(system, found), dict[Word, Fraction]()
        for own, share in zip(inertia, shares, strict=True):
            for word, factor in share.items():
                matrix[word] = matrix.get(word, ZERO) + own * factor
        # where a sum is zero by chance the matrix has no word for it
        known = {name: place for name, place in places.items() if all(place >= 0 for _, place in shares[place])}
        wanted = tuple(names.index(name) for name in system.wanted)
        masses = cls(inertia, known, wanted, shares, matrix)
        return masses if masses._is_all(system, source) else None

    def _is_all(self, system: SystemData, source: Model) -> bool:
        """Whether nothing else changes, seen by moving all."""
        rank = {place: number / len(self._order) for number, place in enumerate(self._order)}
        share = {name: 1.0 + PROBE * (1.0 + rank[place]) for name, place in self.places.items()}
        moved = {name: float(self.inertia[place]) * share[name] for name, place in self.places.items()}
        return is_all(system, source, moved, self.patches(moved) or [])

    @cached_property
    def _order(self) -> list[int]:
        return order(self.inertia, self.wanted)

    @cached_property
    def _sizes(self) -> list[float]:
        return list(map(float, self.inertia))

    def _keeps_order(self, inertia: Sequence[Fraction], moved: Iterable[int]) -> bool:
        """Whether the same speeds stay independent with other inertias at some places."""
        sizes = self._sizes.copy()
        for place in moved:
            sizes[place] = float(inertia[place])
        rest = self._order[: len(inertia) - len(self.wanted)]
        # as `order` has them: floats mostly tell them apart
        return all(
            sizes[a] < sizes[b] or (sizes[a] == sizes[b] and (inertia[a], -a) < (inertia[b], -b))
            for a, b in pairwise(rest)
        )

    def patches(self, changes: Mapping[str, Any]) -> list[Patch] | None:
        """The words of other inertias; None where others change too.

        Parameters: changes, values by name.
        """
        if not changes.keys() <= self.places.keys() or not all(map(_is_inertia, changes.values())):
            return None
        inertia, sums = list(self.inertia), dict[Word, tuple[int, int]]()
        for name, value in changes.items():
            place = self.places[name]
            inertia[place] = exact(value)
            more = inertia[place] - self.inertia[place]
            for word, factor in self.shares[place].items():
                # unreduced, which is quicker than a Fraction and has the same quotient
                above, below = sums.get(word) or self.matrix[word].as_integer_ratio()
                by = more.denominator * factor.denominator
                sums[word] = above * by + more.numerator * factor.numerator * below, below * by
        if not self._keeps_order(inertia, map(self.places.__getitem__, changes)):
            return None
        found = [Patch("inertia", self.places[name], [float(value)]) for name, value in changes.items()]
        for (array, place), (above, below) in sums.items():
            try:
                # the quotient of two whole numbers is rounded once
                value = above / below
            except OverflowError:
                return None
            if not value and array == "mass_value":
                return None
            found.append(Patch(array, place, [value]))
        return found

    def derivatives(self, name: str) -> Mapping[Word, float]:
        """Derivatives of the words by an inertia, which hold wherever the same speeds are independent."""
        place = self.places[name]
        return {("inertia", place): 1.0} | {word: float(factor) for word, factor in self.shares[place].items()}


def is_all(system: SystemData, source: Model, moved: Mapping[str, float], found: list[Patch]) -> bool:
    """Whether assembling a model with other numbers changes the arrays as patches do, and nothing else."""
    given = assembled(changed_model(source, moved), system.wanted)["arrays"]
    own = {**system.arrays, **patched(system.arrays, found)}
    return all(given[name].tobytes() == array.tobytes() for name, array in own.items())


def _is_inertia(value: Any) -> bool:
    return type(value) in (float, int) and 0.0 < value < inf


def judges(element: Component) -> bool:
    """Whether an element of another package has rules, which may look at inertias and speeds."""
    kind = type(element)
    return kind.problems is not Component.problems and not kind.__module__.startswith("clutchwork.")


def _shares(system: SystemData, found: Structure) -> list[dict[Word, Fraction]]:
    """Derivatives of the words of the mass matrix by each inertia; a place below 0: the matrix has no such word."""
    made, _, _ = chosen(found, system.wanted)
    columns = SpeedColumns(found.mechanism, made)
    known = [(row, place) for row, places in enumerate(supports(system.arrays, "mass")) for place in places]
    number, width = {entry: place for place, entry in enumerate(known)}, len(columns.prescribed)
    # what follows from a transmission has no inertia
    rows = {node: row for row, node in enumerate(made.independent) if node not in made.followers.values()}

    def words(speed: Mapping[int, Fraction]) -> Iterator[tuple[Word, Fraction]]:
        for node in speed.keys() & rows.keys():
            for column, value in speed.items():
                if column in columns.speeds:
                    word = ("mass_value", number.get((rows[node], columns.speeds[column]), -1))
                else:
                    word = ("mass_prescribed", rows[node] * width + columns.prescribed[column])
                yield word, speed[node] * value

    return [dict(words(speed)) for speed in made.speeds]


def is_mass(name: str) -> bool:
    """Whether a name may be that of an inertia or a mass."""
    return name.endswith((".inertia", ".mass"))


@memoize
def masses(system: SystemData) -> Masses | None:
    """Those of a System, found once."""
    try:
        return None if system.source is None else Masses.of(system, system.source)
    except ModelError:
        return None
