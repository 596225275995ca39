"""A gearbox from whatever its users give for one: an object, a name of the catalogue, a file, its content."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, lru_cache
from typing import Any, NamedTuple

from clutchwork.base import ModelError, Problem, advised, quote
from clutchwork.gearbox import checks, store
from clutchwork.gearbox.definition import Definition


class ReadGearbox(NamedTuple):
    """A gearbox, None where it has mistakes, and these: message and remedy."""

    box: Definition | None
    problems: tuple[tuple[str, str], ...] = ()


def read(source: Any) -> ReadGearbox:
    """A gearbox, or what is wrong with it."""
    if isinstance(source, Definition):
        found = _problems(source)
        return ReadGearbox(None if found else source, found)
    if not isinstance(source, str | Mapping):
        remedy = "give a cw.Gearbox, a name of the catalogue, the path of a TOML file, or its content"
        return ReadGearbox(None, ((f"is not a gearbox: {quote(source)}", remedy),))
    try:
        return ReadGearbox(_named(source) if isinstance(source, str) else store.from_data(source))
    except ModelError as error:
        return ReadGearbox(None, _told(error.problems))


@cache
def _of_catalogue(name: str) -> Definition:
    return store.definition(name)


def _named(source: str) -> Definition:
    """Files may change, the catalogue does not."""
    return store.definition(source) if source.lower().endswith(store.ENDINGS) else _of_catalogue(source)


@lru_cache
def _problems(box: Definition) -> tuple[tuple[str, str], ...]:
    return _told(checks.problems(box))


def _told(problems: Any) -> tuple[tuple[str, str], ...]:
    found: list[Problem] = list(problems)
    return tuple((_words(problem), problem.remedy) for problem in found)


def _words(problem: Problem) -> str:
    """A mistake of a gearbox as part of a sentence about the element that has it."""
    # one that is not in the catalogue is named already
    if problem.path.startswith("gearbox ") and not (problem.quantity or problem.value or problem.line):
        return f"{problem.path.removeprefix('gearbox ')} {advised(problem.message, '')}"
    where = ": ".join(word for word in (problem.path, problem.quantity) if word)
    line = f"line {problem.line}: " if problem.line else ""
    given = f" = {problem.value}:" if problem.value else ""
    return f"is wrong: {line}{where}{given} {advised(problem.message, '')}"
