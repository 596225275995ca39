"""What can go wrong with a fit."""

from __future__ import annotations

from typing import Any

from clutchwork.base.errors import ClutchworkError
from clutchwork.base.extras import need


class FitError(ClutchworkError, ValueError):
    """Measurements or settings that no fit can use, with the remedy."""

    def __init__(self, quantity: str, message: str, remedy: str) -> None:
        self.quantity, self.message, self.remedy = quantity, message, remedy
        super().__init__(f"{quantity} {message}; {remedy}")


def scipy(module: str) -> Any:
    """A module of SciPy, imported now; ImportError with the remedy when there is none."""
    return need(f"scipy.{module}", "fit", "a fit")
