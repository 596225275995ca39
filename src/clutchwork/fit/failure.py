"""What can go wrong with a fit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from clutchwork.base.errors import ClutchworkError, advised
from clutchwork.base.extras import need
from clutchwork.base.text import counted


class FitError(ClutchworkError, ValueError):
    """Measurements or settings that no fit can use, with the remedy; several of them are in `problems`."""

    def __init__(self, quantity: str, message: str, remedy: str, problems: Sequence[FitError] = ()) -> None:
        self.quantity, self.message, self.remedy = quantity, message, remedy
        self.problems: tuple[FitError, ...] = tuple(problems) or (self,)
        told = advised(f"{quantity} {message}", remedy)
        if problems:
            told = "\n".join([counted(len(problems), "problems"), *(f"  {one}" for one in problems)])
        super().__init__(told)


def refuse(problems: Sequence[FitError]) -> None:
    """Raise what is wrong, all of it at once; nothing where nothing is."""
    if len(problems) == 1:
        raise problems[0]
    if problems:
        first = problems[0]
        raise FitError(first.quantity, first.message, first.remedy, problems)


def scipy(module: str) -> Any:
    """A module of SciPy, imported now; ImportError with the remedy when there is none."""
    return need(f"scipy.{module}", "fit", "a fit")
