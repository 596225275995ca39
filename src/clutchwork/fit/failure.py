"""What can go wrong with a fit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import ClutchworkError, advised, counted
from clutchwork.base.extras import need
from clutchwork.fit.words import plain


class FitError(ClutchworkError, ValueError):
    """Measurements or settings that no fit can use, with the remedy; several of them are in `problems`.

    `result` is the fit where it was made and describes nothing, to be looked at: `error.result.plot("fit.png")`.
    """

    result: Any = None

    def __init__(self, quantity: str, message: str, remedy: str, problems: Sequence[FitError] = ()) -> None:
        self.quantity, self.message, self.remedy = quantity, message, remedy
        self.problems: tuple[FitError, ...] = tuple(problems) or (self,)
        told = advised(f"{quantity} {message}", remedy)
        if problems:
            told = "\n".join([counted(len(problems), "problems"), *(f"  {one}" for one in problems)])
        super().__init__(told)


def refuse(problems: Sequence[FitError]) -> None:
    """Raise what is wrong, all of it at once and each once; nothing where nothing is."""
    problems = list({str(one): one for one in problems}.values())
    if len(problems) == 1:
        raise problems[0]
    if problems:
        first = problems[0]
        raise FitError(first.quantity, first.message, first.remedy, problems)


def all_of(*checks: Callable[[], Any]) -> list[Any]:
    """What each returns; what is wrong with all of them is raised at once."""
    found, problems = list[Any](), list[FitError]()
    for check in checks:
        try:
            found.append(check())
        except FitError as error:
            problems += error.problems
    refuse(problems)
    return found


def scipy(module: str) -> Any:
    """A module of SciPy, imported now; ImportError with the remedy when there is none."""
    return need(f"scipy.{module}", "fit", "a fit")


def described_by_nothing(r2: float, causes: Sequence[str], result: Any) -> FitError:
    """The error of a fit that is worse than the mean of its samples.

    Parameters: causes, those that are likely.
    """
    told = f"describes the samples worse than their mean does: r2 is {plain(r2, 3)}"
    usual = "check units (1/min or rad/s), that no columns are swapped, the load, what is not free and the bounds, try "
    usual += "other start values, another law or model, or loss='soft_l1' for samples that are off"
    error = FitError("fit", "; ".join([told, *causes]), usual)
    error.result = result
    return error


def rising(rows: dict[str, NDArray[np.float64]]) -> str:
    """What to say where times do not rise and another row does."""
    found = [name for name, row in rows.items() if len(row) > 1 and np.all(np.diff(row) > 0.0)]
    return f"; {found[0]} rises: likely time and {found[0]} are swapped" if found else ""


def numbers_of(name: str, given: Any) -> NDArray[np.float64]:
    """A row of numbers."""
    try:
        found = np.array(given, dtype=float)
    except (TypeError, ValueError):
        raise FitError(name, "contains something that is not a number", "give a row of numbers") from None
    if found.ndim != 1:
        raise FitError(name, f"has {found.ndim} dimensions", "give a row of numbers")
    return found
