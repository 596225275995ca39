"""Ratios that vary, at an instant: docs/theory/linearisation.md (10)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from clutchwork.assembly.wiring import HOUSING
from clutchwork.base.arrays import Array

if TYPE_CHECKING:
    from clutchwork.linear.instant import Instant


class Ties:
    """Rows of the transmissions over speeds and prescribed speeds, and what is known of them at the instant."""

    def __init__(self, instant: Instant, ratio: Array, D: Array, delta: Array) -> None:
        first = self.first = np.asarray(instant.system.transmission_element, dtype=int)
        second = self.second = first + 1
        self.followers = np.asarray(instant.system.transmission_speed, dtype=int)
        self.ratio = ratio
        self.row = D[first] - self.ratio[:, None] * D[second]
        self.shift = delta[first] - self.ratio[:, None] * delta[second]
        self.torque = instant.part("element_torque")[first]
        self.rate = self._over(instant, "speed")
        self.acceleration = self._over(instant, "acceleration")

    def _over(self, instant: Instant, part: str) -> Array:
        """Second rate of each, or its time derivative."""
        moving, branches = instant.part(part), instant.wiring.elements
        found = [
            sum(factor * moving[node] for node, factor in branches[way].direction.items() if node != HOUSING)
            for way in self.second
        ]
        return np.array(found, dtype=float)

    def beside(self, B: Array, beta: Array) -> tuple[Array, Array]:
        """Rows of locked contacts and of these, over speeds; over prescribed speeds and changes of the ties."""
        held, ties = len(B), len(self.first)
        changes = np.vstack([np.zeros((held, ties)), -np.eye(ties)])
        return np.vstack([B, self.row]), np.hstack([np.vstack([beta, self.shift]), changes])

    def mass(self, mass: Array) -> Array:
        """The mass matrix without the units that stand for speeds that follow."""
        made = mass.copy()
        places = self.followers[self.followers >= 0]
        made[places, places] = 0.0
        return made
