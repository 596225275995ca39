"""Verbs of things whose work is done in rooms above: the face says by whom, when the package is imported."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

F = TypeVar("F", bound=Callable[..., Any])

_WORK: dict[str, Callable[..., Any]] = {}


def does(verb: str) -> Callable[[F], F]:
    """Register the function that a verb calls."""

    def register(function: F) -> F:
        _WORK[verb] = function
        return function

    return register


def do(verb: str, *given: Any) -> Any:
    """Call the function that is registered for a verb."""
    return _WORK[verb](*given)
