"""Random formulas of friction laws, as a model file holds them: sums of falling parts over numbers that they name."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

Rng = np.random.Generator


class Draft:
    """An expression that grows, and the numbers that it names."""

    def __init__(self, rng: Rng) -> None:
        self.rng = rng
        self.numbers: dict[str, Any] = {}

    def number(self, low: float, high: float, unit: str = "") -> str:
        """A number between two bounds: written as it is, or by a name, with its unit or without."""
        value = float(f"{math.exp(self.rng.uniform(math.log(low), math.log(high))):.3g}")
        if self.rng.random() < 0.3:
            return repr(value)
        name = f"n{len(self.numbers) + 1}"
        self.numbers[name] = f"{value!r} {unit}" if unit and self.rng.random() < 0.4 else value
        return name

    def slip(self) -> str:
        """A slip over a speed, not negative."""
        written = str(self.rng.choice(["v", "abs(v)"]))
        return f"{written}/{self.number(0.3, 50.0, 'rad/s')}"

    def share(self, depth: int = 0) -> str:
        """Something between zero and one."""
        x, power = self.slip(), float(f"{self.rng.uniform(0.5, 2.5):.3g}")
        kinds = [f"exp(-{x})", f"exp(-({x})**2)", f"1/(1 + {x})", f"1/(1 + ({x})**2)", f"(1 - tanh({x}))"]
        kinds += [f"(1 - 0.6*atan({x}))", f"0.5*(1 + cos({x}))", f"1/(1 + log(1 + {x}))", f"1/sqrt(1 + {x})"]
        kinds += [f"max(0, 1 - {x})", f"min(1, 1/(0.5 + {x}))", f"where({x} < 1, 1 - 0.5*({x}), 0.5)"]
        kinds += [f"exp(-({x} + 0.01)**{power})"]
        found = str(self.rng.choice(kinds))
        return f"{found}*{self.share(depth + 1)}" if depth < 2 and self.rng.random() < 0.3 else found

    def level(self) -> str:
        """A coefficient."""
        found = self.number(0.05, 0.3)
        for _ in range(int(self.rng.integers(0, 3))):
            found += f" + {self.number(0.01, 0.2)}*{self.share()}"
        return found


def drawn(rng: Rng, sticks: bool, warm: bool = False) -> dict[str, Any]:
    """Fields of a law: one that sticks, or bristles under such a level; `warm`: it may read its temperature."""
    draft = Draft(rng)
    level = draft.level()
    if warm and rng.random() < 0.4:
        level = f"({level})*(1.1 - {draft.number(1e-5, 5e-4, '1/K')}*(temperature - 280))"
    if sticks:
        at_rest = {"at_rest": draft.number(0.9, 1.5)} if rng.random() < 0.5 else {}
        return {"expression": level, **at_rest, **draft.numbers}
    bending = f"(v - abs(v)*z/({level}))"
    expression = "z" if rng.random() < 0.5 else f"z + {draft.number(1e-4, 3e-3)}*v"
    rates = {"z": f"{draft.number(100.0, 3000.0, '1/rad')}*{bending}"}
    return {"expression": expression, "rates": rates, "at_rest": draft.number(0.3, 1.0), **draft.numbers}
