"""What follows from a thing that never changes: found once, kept in the thing, gone with it."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar, TypeVarTuple, Unpack

T = TypeVar("T")
R = TypeVar("R")
Ts = TypeVarTuple("Ts")

# the attribute that holds it; what copies a thing or sends it on leaves it out
KEPT = "_kept"


def memoize(function: Callable[[T, Unpack[Ts]], R]) -> Callable[[T, Unpack[Ts]], R]:
    """Cache the result of a function on its first argument, for each set of further arguments.

    Threads that ask for the first time together may each make it; all get the one that was there first.
    """

    @wraps(function)
    def found(thing: T, *args: *Ts) -> R:
        known: dict[Any, R] = vars(thing).setdefault(KEPT, {})
        key = (function, *args)
        return known[key] if key in known else known.setdefault(key, function(thing, *args))

    return found
