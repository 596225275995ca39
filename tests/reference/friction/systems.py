"""A law and what moves it, as an initial value problem."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from reference.friction.law import Array, Branch, Law

Course = Callable[[float], float]


@dataclass(frozen=True)
class Pushed:
    """A mass under a force, y = (position, speed, states)."""

    law: Law
    force: Course
    load: Course = lambda t: 1.0
    mass: float = 1.0

    def start(self) -> Array:
        return np.zeros(2 + self.law.size)

    def slip(self, t: float, y: Array) -> float:
        return y[1]

    def slope(self, t: float, y: Array, branch: Branch) -> Array:
        v, s = y[1], y[2:]
        pull = self.force(t) - self.load(t) * self.law.coefficient(v, s, branch)
        return np.array([v, pull / self.mass, *self.law.rates(v, s, branch)])

    def rest(self, y: Array) -> Array:
        y[1] = 0.0
        return y


@dataclass(frozen=True)
class Moved:
    """A slip that is given, y = (position, states)."""

    law: Law
    speed: Course
    load: Course = lambda t: 1.0

    def start(self) -> Array:
        return np.zeros(1 + self.law.size)

    def slip(self, t: float, y: Array) -> float:
        return self.speed(t)

    def slope(self, t: float, y: Array, branch: Branch) -> Array:
        v = self.speed(t)
        return np.array([v, *self.law.rates(v, y[1:], branch)])

    def rest(self, y: Array) -> Array:
        return y
