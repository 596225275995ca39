"""The compiled core, loaded on first use, and the index of each declaration in it."""

from __future__ import annotations

from collections import Counter
from functools import cache
from importlib import import_module
from typing import Any

from clutchwork.declare.layout import layout_text
from clutchwork.declare.schema import REGISTRY, Role, compiled_text

REMEDY = "build it in the project folder: make setup, or pip install -e ."
STALE = f"the compiled core of clutchwork was built from other declarations; {REMEDY}"


@cache
def core() -> Any:
    """The module of the core; ImportError with the remedy when it is missing or was built for another layout."""
    try:
        found = import_module("clutchwork._core")
    except ImportError as error:
        raise ImportError(f"the compiled core of clutchwork cannot be loaded ({error}); {REMEDY}") from error
    if getattr(found, "layout", "") != layout_text():
        raise ImportError(STALE)
    return found


@cache
def derivatives() -> Any:
    """The module of runs with derivatives; ImportError with the remedy when it is missing or does not fit."""
    try:
        found = import_module("clutchwork._derivatives")
    except ImportError as error:
        message = "derivatives of runs are computed by a compiled module of their own, which cannot be loaded"
        raise ImportError(f"{message} ({error}); {REMEDY}") from None
    if (found.layout, found.schema) != (core().layout, core().schema):
        raise ImportError(f"the compiled derivatives of clutchwork were built from other declarations; {REMEDY}")
    if not found.supported():
        raise ImportError(
            "the compiled derivatives of clutchwork were built for another processor; run make clean setup"
        )
    return found


def number(cls: Any) -> int:
    """Index of a declaration in the core within its role; ImportError if the core was built from another."""
    return _number(cls.role, cls.kind)


@cache
def _number(role: Role, kind: str) -> int:
    place = _places().get(compiled_text(REGISTRY[role][kind]))
    if place is None:
        raise ImportError(f"{STALE} (it has no {kind} with these fields)")
    return place


@cache
def _places() -> dict[str, int]:
    """Index of each declaration among those of its role, by its text, as the core was built."""
    counted, places = Counter[str](), dict[str, int]()
    for line in core().schema.splitlines():
        role = line.partition(" ")[0]
        places[line] = counted[role]
        counted[role] += 1
    return places
