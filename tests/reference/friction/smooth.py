"""Laws without states."""

from __future__ import annotations

from dataclasses import dataclass
from math import tanh

from reference.friction.curve import Curve
from reference.friction.law import Array, Branch, Law


@dataclass(frozen=True)
class Tanh(Law):
    """kinetic tanh(2 v/speed)."""

    kinetic: float
    speed: float

    def coefficient(self, v: float, s: Array, branch: Branch) -> float:
        return self.kinetic * tanh(2.0 * v / self.speed)


@dataclass(frozen=True)
class RegularisedStribeck(Law):
    """s(v) tanh(v/width) + viscous v."""

    curve: Curve
    width: float

    def coefficient(self, v: float, s: Array, branch: Branch) -> float:
        return self.curve.level(v) * tanh(v / self.width) + self.curve.viscous * v


@dataclass(frozen=True)
class NaiveSign(Law):
    """sign(v) s(v) + viscous v, for slip that is prescribed: with a mass it has no solution at rest."""

    curve: Curve

    @property
    def kinked(self) -> bool:
        return True

    def coefficient(self, v: float, s: Array, branch: Branch) -> float:
        return branch.way * self.curve.level(v) + self.curve.viscous * v
