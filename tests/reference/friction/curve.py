"""The Stribeck curve, written down again."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp


@dataclass(frozen=True)
class Curve:
    """Level of sliding friction over speed and the viscous part, both per unit of normal load."""

    static: float
    kinetic: float
    speed: float
    shape: str = "gaussian"
    exponent: float = 2.0
    viscous: float = 0.0

    def level(self, v: float) -> float:
        """s(v) without the viscous part."""
        x = abs(v) / self.speed
        falls = {
            "gaussian": lambda: exp(-(x**2)),
            "tustin": lambda: exp(-x),
            "lorentz": lambda: 1.0 / (1.0 + x**2),
            "power": lambda: exp(-(x**self.exponent)),
        }
        return self.kinetic + (self.static - self.kinetic) * falls[self.shape]()
