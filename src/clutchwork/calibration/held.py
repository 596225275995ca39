"""A limit with the values that were found."""

from __future__ import annotations

from clutchwork.base.classes import dataclass


@dataclass(frozen=True)
class Held:
    """A limit, and what it is with the values that were found."""

    name: str
    unit: str
    lower: float
    upper: float
    before: tuple[float, float]  # least and largest value with the values of the model
    after: tuple[float, float]
    active: bool
    multiplier: float  # by how much the goal gets less where the bound moves out by one, both in SI
