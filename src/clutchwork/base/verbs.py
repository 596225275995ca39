"""Verbs of things whose work is done in rooms above: the face says by whom, when the package is imported."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])

_WORK: dict[str, Callable[..., Any]] = {}


def does(verb: str) -> Callable[[F], F]:
    """Mark the function that does the work of a verb."""

    def register(function: F) -> F:
        _WORK[verb] = function
        return function

    return register


def do(verb: str, *given: Any) -> Any:
    """Let the work of a verb be done."""
    return _WORK[verb](*given)
