"""What differs from one episode to the next."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from clutchwork.base.shown import shown
from clutchwork.learn.ranges import is_range

Draw = Callable[[np.random.Generator], Any]


def variation(given: object) -> tuple[dict[str, Draw], list[str]]:
    """How to draw each value, and what is wrong with the way it is given."""
    if not isinstance(given, Mapping):
        return {}, [f"vary is {shown(given)}: give a mapping from names to (low, high)"]
    made, wrong = dict[str, Draw](), list[str]()
    for name, how in given.items():
        if callable(how):
            made[name] = how
        elif isinstance(how, tuple) and is_range(how):
            made[name] = partial(_evenly, *how)
        elif isinstance(how, list) and how:
            made[name] = partial(_one_of, how)
        else:
            ways = "(low, high), a list to choose from, or a function of a numpy Generator"
            wrong.append(f"vary of {shown(name)} is {shown(how)}: give {ways}")
    return made, wrong


def _evenly(low: float, high: float, generator: np.random.Generator) -> float:
    return float(generator.uniform(min(low, high), max(low, high)))


def _one_of(values: list[Any], generator: np.random.Generator) -> Any:
    return values[int(generator.integers(len(values)))]
