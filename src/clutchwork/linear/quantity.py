"""A state, an input or an output by name."""

from __future__ import annotations

from clutchwork.base import dataclass


def per_second(unit: str) -> str:
    """Unit of the rate of a quantity."""
    return {"rad/s": "rad/s2", "m/s": "m/s2", "1": "1/s"}.get(unit, f"{unit}/s")


@dataclass(frozen=True)
class Quantity:
    """A state, an input or an output: name, unit, value at the instant, and for a state its rate per second."""

    name: str
    unit: str
    value: float
    rate: float = 0.0


def amount(value: float, unit: str) -> str:
    """A value with its unit."""
    return f"{value:.6g}" if unit in ("1", "") else f"{value:.6g} {unit}"
