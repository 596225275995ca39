"""Mykhalevych's law; the state is the wind-up over the elastic angle."""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, exp, tanh

from reference.friction.law import Array, Branch, Guard, Law


@dataclass(frozen=True)
class Mykhalevych(Law):
    """static tanh(q) - sign(v) (static - kinetic) (1 - exp(-(v/speed)^2)), q = p + viscous v/speed; mark: p is full."""

    static: float
    kinetic: float
    elastic: float
    speed: float
    viscous: float
    reset: str = "saturate"
    range: float = 3.0
    passive: bool = False

    @property
    def size(self) -> int:
        return 1

    def start(self) -> Branch:
        return Branch(marks=(0,))

    def coefficient(self, v: float, s: Array, branch: Branch) -> float:
        wound, left = tanh(s[0] + self.viscous * v / self.speed), exp(-((v / self.speed) ** 2))
        if self.passive:
            return (self.kinetic + (self.static - self.kinetic) * left) * wound
        return self.static * wound - branch.way * (self.static - self.kinetic) * (1.0 - left)

    def rates(self, v: float, s: Array, branch: Branch) -> list[float]:
        return [0.0 if branch.marks[0] else v / self.elastic]

    def turned(self, s: Array, branch: Branch) -> tuple[Array, Branch]:
        if self.reset == "literal" or (self.reset == "clip" and abs(s[0]) > 1.0):
            s[0] = copysign(1.0, s[0]) if s[0] else 0.0
        return s, branch.marked(0, 0)

    def guards(self, branch: Branch) -> list[Guard]:
        if self.reset != "saturate" or branch.marks[0]:
            return []

        def switch(s: Array, branch: Branch) -> tuple[Array, Branch]:
            s[0] = branch.way * self.range
            return s, branch.marked(0, 1)

        return [Guard(lambda v, s: self.range - branch.way * s[0], switch)]
