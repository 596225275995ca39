"""Errors that carry the remedy."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Iterable, Sequence
from itertools import islice
from typing import Any

from clutchwork.base.classes import dataclass
from clutchwork.base.plural import counted
from clutchwork.base.quote import LONGEST, printable, quote, shortened


@dataclass(frozen=True, repr=False)
class Problem:
    """One mistake in a model: where it is, what is wrong, and what to do about it."""

    path: str  # 'element "c1" (clutch)'
    quantity: str  # "gain", empty when it is about the whole
    message: str  # "must be > 0 m3"
    value: str = ""  # "-0.2 m3" as it was given
    remedy: str = ""
    line: int = 0  # in the model file, 0 where it is not known

    def __str__(self) -> str:
        path, quantity = shortened(self.path), shortened(self.quantity)
        where = f"{path}: {quantity}" if quantity else path
        given = f" = {shortened(self.value)}" if self.value else ""
        separator = ": " if given or not quantity else " "
        return printable(f"{where}{given}{separator}{advised(self.message, self.remedy)}")

    def __repr__(self) -> str:
        """As a list of problems shows it: what `print` shows."""
        return f"<{type(self).__name__} {self}>"


def advised(message: str, remedy: str) -> str:
    """A message and what to do about it, as one sentence; a question has its own end."""
    return f"{message}{' ' if message.endswith('?') else '; '}{remedy}" if remedy else message


class ClutchworkError(Exception):
    """Base of all errors of this package."""


# further problems are in `ModelError.problems`
MOST_LINES = 200


class ModelError(ClutchworkError, ValueError):
    """A model that cannot be used: all its mistakes at once, in `problems`."""

    def __init__(self, problems: Sequence[Problem], source: str = "") -> None:
        self.problems = tuple(problems)
        self.source = source
        count = counted(len(self.problems), "problems")
        head = f"{printable(shortened(source))}: {count}" if source else f"{count} in the model"
        lines = [f"  line {p.line}: {p}" if p.line else f"  {p}" for p in self.problems[:MOST_LINES]]
        more = len(self.problems) - MOST_LINES
        super().__init__("\n".join([head, *lines, *([f"  and {more} more"] if more > 0 else [])]))

    def __reduce__(self) -> tuple[type, tuple[Sequence[Problem], str]]:
        return type(self), (self.problems, self.source)


class ModelFileError(ModelError):
    """A model file that is not there or cannot be read."""


class UseError(ClutchworkError, TypeError):
    """A call with wrong arguments: all its mistakes at once, in `problems`."""

    def __init__(self, call: str, problems: Sequence[str]) -> None:
        self.call, self.problems = call, tuple(problems)
        head = f"{call}: {counted(len(self.problems), 'problems')}"
        super().__init__("\n".join([head, *(f"  {printable(problem)}" for problem in self.problems)]))

    def __reduce__(self) -> tuple[type, tuple[str, Sequence[str]]]:
        return type(self), (self.call, self.problems)


class OptionError(ClutchworkError, ValueError):
    """Options of a run that make no sense: all mistakes at once, in `problems`."""

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(self.problems))

    def __reduce__(self) -> tuple[type, tuple[Sequence[str]]]:
        return type(self), (self.problems,)


class UnknownName(ClutchworkError, KeyError):  # noqa: N818, it is what the name of a signal or contact is
    """A name that a result does not have."""

    def __str__(self) -> str:
        return str(self.args[0])


class ModelWarning(UserWarning):
    """A model that runs but has a property that is rarely wanted; `problem` says where, what and what to do."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        super().__init__(str(problem))


def warn(advice: Problem) -> None:
    """Warn at the line outside this package that asked."""
    warnings.warn(ModelWarning(advice), stacklevel=caller())


def caller() -> int:
    """The `stacklevel` of the line outside this package, for a warning of the function that asks."""
    package, asking = __name__.partition(".")[0], inspect.currentframe()
    frame, level = asking.f_back if asking else None, 1
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame, level = frame.f_back, level + 1
    return level


class FileError(ClutchworkError, ValueError):
    """A file beside a model that cannot be used: all that is wrong, as (quantity, what is wrong, remedy)."""

    def __init__(self, problems: Sequence[tuple[str, str, str]]) -> None:
        self.problems = list(problems)
        super().__init__("\n".join(printable(advised(message, remedy)) for _, message, remedy in self.problems))

    def __reduce__(self) -> tuple[type, tuple[Sequence[tuple[str, str, str]]]]:
        return type(self), (self.problems,)


class FMUError(ClutchworkError, ValueError):
    """An FMU of other people that cannot be read, or that fails in a run, with its name and the instant."""


def expect(call: str, name: str, value: object, kind: Any, remedy: str) -> None:
    """UseError where an argument is of another kind."""
    if not isinstance(value, kind):
        raise UseError(call, [f"{name} is {quote(value)}: {remedy}"])


# comparing takes time in proportion to the product of both
MOST_COMPARED = 500


def near(name: object, known: Iterable[str], rest: str = "") -> str:
    """`; did you mean ...?` when a known name is close to a misspelt one, then the rest of the sentence."""
    found = nearest(name, known)
    return advised(f"; did you mean {found!r}?", rest) if found else rest and f"; {rest}"


def nearest(name: object, known: Iterable[str]) -> str:
    """The known name that is close to a misspelt one, empty where there is none."""
    word = name if isinstance(name, str) else ""
    likely = [other for other in islice(known, MOST_COMPARED) if isinstance(other, str) and len(other) <= LONGEST]
    if not 0 < len(word) <= LONGEST:
        return ""
    # only mistakes need it
    from difflib import get_close_matches

    return next(iter(get_close_matches(word, likely, n=1, cutoff=0.6 if len(word) > 3 else 0.5)), "")
