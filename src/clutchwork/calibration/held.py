"""A limit with the values that were found."""

from __future__ import annotations

from clutchwork.base import dataclass


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
    broken: bool  # by more than round-off
    by_lower: float  # derivative of the least goal by the lower bound, both in SI; 0 where it does not bind
    by_upper: float  # the same by the upper one; of an equation, whose bounds move together, both are the same

    @property
    def is_equal(self) -> bool:
        """Whether one value alone is allowed."""
        return self.lower == self.upper

    @property
    def multiplier(self) -> float:
        """Reduction of the goal per unit by which the active bound is relaxed, or the requirement raised."""
        return -self.by_upper if self.is_equal else self.by_lower - self.by_upper
