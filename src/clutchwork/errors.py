"""Errors that carry the remedy."""

from __future__ import annotations

import inspect
import warnings
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


@dataclass(frozen=True)
class Problem:
    """One mistake in a model: where it is, what is wrong, and what to do about it."""

    path: str  # 'element "c1" (clutch)'
    quantity: str  # "gain", empty when it is about the whole
    message: str  # "must be > 0 m3"
    value: str = ""  # "-0.2 m3" as it was given
    remedy: str = ""

    def __str__(self) -> str:
        where = f"{self.path}: {self.quantity}" if self.quantity else self.path
        given = f" = {self.value}" if self.value else ""
        separator = ": " if given or not self.quantity else " "
        return f"{where}{given}{separator}{self.message}" + (f"; {self.remedy}" if self.remedy else "")


class ClutchworkError(Exception):
    """Base of all errors of this package."""


class ModelError(ClutchworkError, ValueError):
    """A model that cannot be used: all its mistakes at once, in `problems`."""

    def __init__(self, problems: Sequence[Problem], source: str = "") -> None:
        self.problems = tuple(problems)
        self.source = source
        count = f"{len(self.problems)} problems" if len(self.problems) > 1 else "1 problem"
        head = f"{source}: {count}" if source else f"{count} in the model"
        super().__init__("\n".join([head, *(f"  {problem}" for problem in self.problems)]))


class ModelWarning(UserWarning):
    """A model that runs but has a property that is rarely wanted; `problem` says where, what and what to do."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        super().__init__(str(problem))


def warn(advice: Problem) -> None:
    """Warn at the line outside this package that asked."""
    frame, level = inspect.currentframe(), 1
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == __package__:
        frame, level = frame.f_back, level + 1
    warnings.warn(ModelWarning(advice), stacklevel=level)


class FileError(ClutchworkError, ValueError):
    """A file beside a model that cannot be used."""

    def __init__(self, quantity: str, message: str, remedy: str) -> None:
        self.quantity, self.message, self.remedy = quantity, message, remedy
        super().__init__(f"{message}; {remedy}")


def near(name: str, known: Iterable[str]) -> str:
    """`; did you mean ...?` when a known name is close to a misspelt one, else nothing."""
    found = get_close_matches(str(name), list(known), n=1, cutoff=0.6 if len(str(name)) > 3 else 0.5)
    return f"; did you mean {found[0]!r}?" if found else ""
