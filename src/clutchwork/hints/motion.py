"""What can move in a System, and how easily, when contacts are locked."""

from __future__ import annotations

from collections.abc import Collection
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import HOUSING, wiring
from clutchwork.results.ratios import ROUND_OFF, free_motions

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Array = NDArray[Any]


class SlipAccelerations:
    """Answers for one System; each is found once."""

    def __init__(self, system: System) -> None:
        self._system = system
        self._heavy = np.flatnonzero(np.asarray(system.massless) == 0)
        self._mass = system.mass[np.ix_(self._heavy, self._heavy)]
        self.rates = system.contact_rate[:, self._heavy]
        self.eases = cache(self._eases)
        self.stalls = cache(self._stalls)

    def ease(self, contact: int, locked: tuple[int, ...]) -> float:
        """Slip acceleration of a contact per torque on it [rad/s2 per N m], while others are locked."""
        return float(self.eases(tuple(k for k in locked if k != contact))[contact, contact])

    def _eases(self, locked: tuple[int, ...]) -> Array:
        """Slip acceleration of each contact per torque on each."""
        left = null_space(self.rates[list(locked)])
        turned = self.rates @ left
        made: Array = turned @ np.linalg.solve(left.T @ self._mass @ left, turned.T) if left.size else turned @ turned.T
        # what round-off leaves where nothing moves
        made[np.abs(made) < ROUND_OFF * np.max(np.abs(made), initial=0.0)] = 0.0
        return made

    def ease_of_element(self, element: int) -> float:
        """Rate at which an element speeds up per torque on it, with all contacts open."""
        rate = self._system.element_rate[element, self._heavy]
        return float(rate @ np.linalg.solve(self._mass, rate)) if self._heavy.size else 0.0

    def _stalls(self, contact: int, closed: frozenset[str]) -> bool:
        """Whether the shafts of a contact stand still when contacts of these names are locked; springs are rigid."""
        left = free_motions(self._system, closed)
        nodes = [node for node in wiring(self._system).contacts[contact].direction if node != HOUSING]
        return bool(np.max(np.abs(left[nodes]), initial=0.0) <= ROUND_OFF * max(1.0, np.max(np.abs(left), initial=0.0)))

    def vibration(self, contact: int, slope: float, locked: tuple[int, ...]) -> complex:
        """The root [1/s] of the fastest growing vibration where the torque of a contact falls by `slope` per slip.

        Springs and dampers alone act beside it; zero where nothing grows.
        """
        left = null_space(self.rates[list(locked)])
        parts = [(k, part.component.passive()) for k, part in enumerate(wiring(self._system).elements)]
        found = [(k, passive) for k, passive in parts if passive is not None]
        rates = self._system.element_rate[[k for k, _ in found]][:, self._heavy] @ left
        springs = np.array([passive.stiffness for _, passive in found])
        dampers = np.array([passive.damping for _, passive in found])
        rate = self.rates[contact] @ left
        damping = rates.T @ (dampers[:, None] * rates) - slope * np.outer(rate, rate)
        inverse = np.linalg.inv(left.T @ self._mass @ left)
        # over the speeds and the torques of the springs
        above = np.hstack([-inverse @ damping, -inverse @ rates.T])
        below = np.hstack([springs[:, None] * rates, np.zeros((len(found), len(found)))])
        roots = np.linalg.eigvals(np.vstack([above, below]))
        growing = [complex(root) for root in roots if root.imag > root.real > ROUND_OFF * abs(root)]
        return max(growing, key=lambda root: root.real, default=0j)

    def untouched(self, closed: Collection[int]) -> Array:
        """Motions, one per column over the nodes, on which no element and none of these contacts has a torque."""
        acting = [number for number, part in enumerate(wiring(self._system).elements) if not part.hidden]
        rates = np.vstack([self._system.element_rate[acting][:, self._heavy], self.rates[sorted(closed)]])
        made: Array = self._system.basis[:, self._heavy] @ null_space(rates)
        return made


def null_space(rows: Array) -> Array:
    """Orthonormal columns on which the rows are zero."""
    if not rows.shape[0]:
        return np.eye(rows.shape[1])
    _, sizes, turned = np.linalg.svd(rows, full_matrices=True)
    rank = int(np.sum(sizes > ROUND_OFF * max(1.0, float(np.max(sizes, initial=0.0)))))
    made: Array = turned[rank:].T
    return made
