"""Laws with one elastic deflection z; the state is F = stiffness z."""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, pi, sin

from reference.friction.curve import Curve
from reference.friction.law import Array, Branch, Law


@dataclass(frozen=True)
class Dahl(Law):
    """dF/dt = stiffness v sign(1 - x) abs(1 - x)^exponent with x = F sign(v)/kinetic."""

    kinetic: float
    stiffness: float
    exponent: float = 1.0

    @property
    def size(self) -> int:
        return 1

    def coefficient(self, v: float, s: Array, branch: Branch) -> float:
        return s[0]

    def rates(self, v: float, s: Array, branch: Branch) -> list[float]:
        left = 1.0 - branch.way * s[0] / self.kinetic
        return [self.stiffness * v * copysign(abs(left) ** self.exponent, left)]


@dataclass(frozen=True)
class LuGre(Law):
    """dz/dt = v - abs(v) F/s(v); F + damping dz/dt + viscous v."""

    curve: Curve
    stiffness: float
    damping: float

    @property
    def size(self) -> int:
        return 1

    def bending(self, v: float, force: float, way: int) -> float:
        """dz/dt."""
        return v - way * v * force / self.curve.level(v)

    def coefficient(self, v: float, s: Array, branch: Branch) -> float:
        return s[0] + self.damping * self.bending(v, s[0], branch.way) + self.curve.viscous * v

    def rates(self, v: float, s: Array, branch: Branch) -> list[float]:
        return [self.stiffness * self.bending(v, s[0], branch.way)]


@dataclass(frozen=True)
class ElastoPlastic(LuGre):
    """LuGre whose second term carries alpha(z): 0 up to `elastic`, 1 from `plastic` (0: from s(v)/stiffness) on."""

    elastic: float
    plastic: float = 0.0

    def bending(self, v: float, force: float, way: int) -> float:
        z, steady = force / self.stiffness, self.curve.level(v) / self.stiffness
        return v - self.alpha(way * z, self.plastic or steady) * way * v * z / steady

    def alpha(self, along: float, plastic: float) -> float:
        """Share of sliding; `along` is the deflection in the direction of the slip, below zero on the way back."""
        if along <= self.elastic:
            return 0.0
        if along >= plastic:
            return 1.0
        return 0.5 * sin(pi * (along - 0.5 * (plastic + self.elastic)) / (plastic - self.elastic)) + 0.5
