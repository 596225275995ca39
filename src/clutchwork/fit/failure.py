"""What can go wrong with a fit."""

from __future__ import annotations

import importlib
from typing import Any

from clutchwork.base.errors import ClutchworkError


class FitError(ClutchworkError, ValueError):
    """Measurements or settings that no fit can use, with the remedy."""

    def __init__(self, quantity: str, message: str, remedy: str) -> None:
        self.quantity, self.message, self.remedy = quantity, message, remedy
        super().__init__(f"{quantity} {message}; {remedy}")


def scipy(module: str) -> Any:
    """A module of SciPy, imported now; ImportError with the remedy when there is none."""
    try:
        return importlib.import_module(f"scipy.{module}")
    except ImportError as error:
        raise ImportError('fits need SciPy: pip install "clutchwork[fit]"') from error
