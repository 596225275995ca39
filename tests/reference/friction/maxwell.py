"""Laws of elastic elements in parallel that yield one after the other; the states are the forces of the elements."""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign

import numpy as np

from reference.friction.curve import Curve
from reference.friction.law import Array, Branch, Guard, Law


@dataclass(frozen=True)
class Elements(Law):
    """Points (deflection at break-away, share of the static coefficient)."""

    curve: Curve
    elements: tuple[tuple[float, float], ...]

    @property
    def size(self) -> int:
        return len(self.elements)

    @property
    def stiffness(self) -> list[float]:
        """Of each element."""
        return [share * self.curve.static / deflection for deflection, share in self.elements]

    def start(self) -> Branch:
        return Branch(marks=(0,) * self.size)

    def turned(self, s: Array, branch: Branch) -> tuple[Array, Branch]:
        """Every element sticks when the slip turns."""
        return s, branch._replace(marks=(0,) * self.size)


@dataclass(frozen=True)
class Leuven(Elements):
    """h = sum of Maxwell-slip elements over z; dz/dt = v (1 - sign(v h) abs(h/s)^order); mark: side of its limit."""

    order: float = 1.0
    damping: float = 0.0

    def bending(self, v: float, s: Array, way: int) -> float:
        """dz/dt."""
        along = way * float(np.sum(s)) / self.curve.level(v)
        # no solution goes beyond static/kinetic; iterates of Radau do, and must not overflow
        return v * (1.0 - copysign(min(abs(along), 5.0) ** self.order, along))

    def coefficient(self, v: float, s: Array, branch: Branch) -> float:
        return float(np.sum(s)) + self.damping * self.bending(v, s, branch.way) + self.curve.viscous * v

    def rates(self, v: float, s: Array, branch: Branch) -> list[float]:
        bending = self.bending(v, s, branch.way)
        return [0.0 if mark else k * bending for k, mark in zip(self.stiffness, branch.marks, strict=True)]

    def guards(self, branch: Branch) -> list[Guard]:
        found = []
        for i, mark in enumerate(branch.marks):
            if mark:
                found.append(self._released(i, mark, branch.way))
            else:
                found += [self._limited(i, side) for side in (1, -1)]
        return found

    def _limited(self, i: int, side: int) -> Guard:
        """Element i reaches its limit."""
        limit = self.elements[i][1] * self.curve.static

        def switch(s: Array, branch: Branch) -> tuple[Array, Branch]:
            s[i] = side * limit
            return s, branch.marked(i, side)

        return Guard(lambda v, s: limit - side * s[i], switch)

    def _released(self, i: int, side: int, way: int) -> Guard:
        """The deflection turns back while element i is at its limit, which it does at a standing slip as well."""
        return Guard(lambda v, s: side * self.bending(v, s, way), lambda s, branch: (s, branch.marked(i, 0)))


@dataclass(frozen=True)
class GMS(Elements):
    """Elements that stick, dF/dt = k v, until F = share s(v), and slide, dF/dt = C (share - F/s) towards the slip."""

    attraction: float = 100.0
    damping: float = 0.0

    def coefficient(self, v: float, s: Array, branch: Branch) -> float:
        sticking = sum(share for (_, share), slides in zip(self.elements, branch.marks, strict=True) if not slides)
        return float(np.sum(s)) + (self.curve.viscous + self.damping * sticking) * v

    def rates(self, v: float, s: Array, branch: Branch) -> list[float]:
        level = self.curve.level(v)
        return [
            self.attraction * (branch.way * share - force / level) if slides else k * v
            for (_, share), force, k, slides in zip(self.elements, s, self.stiffness, branch.marks, strict=True)
        ]

    def guards(self, branch: Branch) -> list[Guard]:
        return [self._breaks(i, branch.way) for i, slides in enumerate(branch.marks) if not slides]

    def _breaks(self, i: int, way: int) -> Guard:
        """Element i breaks away."""
        share = self.elements[i][1]
        return Guard(lambda v, s: share * self.curve.level(v) - way * s[i], lambda s, branch: (s, branch.marked(i, 1)))
