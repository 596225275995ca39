"""Other inertias in a System: the mass matrix alone changes, as long as the same speeds are independent."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.assemble import SpeedColumns, assembled, chosen, mass_arrays
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError
from clutchwork.base.memoize import memoize
from clutchwork.declare.rational import exact
from clutchwork.model.changes import all_names, changed_model, named, target
from clutchwork.model.findings import findings
from clutchwork.model.kinematics import order
from clutchwork.model.structure import Kinematics

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.model.model import Model

Arrays = Mapping[str, NDArray[Any]]

# by one to two such shares of their size all inertias are moved, each by another one, to see that no more follows from
# them; the heavier of two by more, so that their order stays
PROBE = 1e-3


@dataclass(frozen=True, eq=False)
class Masses:
    """Inertias of the nodes of a driveline, and how its mass matrix follows from them."""

    inertia: tuple[Fraction, ...]
    places: Mapping[str, int]  # of nodes that have some, by the name of their inertia
    made: Kinematics
    columns: SpeedColumns
    wanted: tuple[int, ...]  # nodes whose speeds were asked for
    pattern: tuple[list[int], list[int]]  # ends and columns of the rows of the matrix

    @classmethod
    def of(cls, system: System, source: Model) -> Masses | None:
        """Those of a System; None where more follows from them, as the weight of a vehicle, or other speeds."""
        found = findings(source).structure
        if found is None:
            return None
        names = [node.name for node in found.mechanism.nodes]
        where = {id(node): place for place, node in enumerate(source.nodes) if node.inertia > 0.0}
        aims = ((name, target(named(source), name)) for name in all_names(source) if is_mass(name))
        places = {name: where[id(aim.owner)] for name, aim in aims if aim and id(aim.owner) in where}
        made, _, _ = chosen(found, system.wanted)
        pattern = system.arrays["mass_end"].tolist(), system.arrays["mass_column"].tolist()
        wanted = tuple(names.index(name) for name in system.wanted)
        masses = cls(tuple(found.mechanism.inertia), places, made, SpeedColumns(found.mechanism, made), wanted, pattern)
        return masses if masses._is_all(system, source) else None

    def _is_all(self, system: System, source: Model) -> bool:
        """Whether nothing else changes, seen by moving all."""
        rank = {place: number / len(self._order) for number, place in enumerate(self._order)}
        share = {name: 1.0 + PROBE * (1.0 + rank[place]) for name, place in self.places.items()}
        moved = {name: float(self.inertia[place]) * share[name] for name, place in self.places.items()}
        given = assembled(changed_model(source, moved), system.wanted)["arrays"]
        own = {**system.arrays, **(self.arrays(moved) or {})}
        return all(given[name].tobytes() == array.tobytes() for name, array in own.items())

    @cached_property
    def _order(self) -> list[int]:
        return order(self.inertia, self.wanted)

    def arrays(self, changes: Mapping[str, float]) -> Arrays | None:
        """The arrays that other inertias change; None where others change too.

        Parameters: changes, values by name.
        """
        if not changes.keys() <= self.places.keys() or not all(0.0 < value < inf for value in changes.values()):
            return None
        inertia = list(self.inertia)
        for name, value in changes.items():
            inertia[self.places[name]] = exact(value)
        if order(inertia, self.wanted) != self._order:
            return None
        try:
            found = mass_arrays(inertia, self.made, self.columns)
        except ArithmeticError:
            return None
        made = {name: np.array(found[name], dtype=float) for name in ("mass_value", "mass_prescribed")}
        made["inertia"] = np.array([float(value) for value in inertia])
        return made if (found["mass_end"], found["mass_column"]) == self.pattern else None


def is_mass(name: str) -> bool:
    """Whether a name may be that of an inertia or a mass."""
    return name.endswith((".inertia", ".mass"))


@memoize
def masses(system: System) -> Masses | None:
    """Those of a System, found once."""
    try:
        return None if system.source is None else Masses.of(system, system.source)
    except ModelError:
        return None
