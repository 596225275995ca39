"""What differs from one episode to the next."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import quote
from clutchwork.learn.ranges import RANGE, InSI, is_range, plain

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Draw = Callable[[np.random.Generator], Any]


def variation(given: object, in_si: InSI) -> tuple[dict[str, Draw], list[dict[str, Any]], list[str]]:
    """How to draw each value, values to try on the model, and what is wrong with the way they are given."""
    if not isinstance(given, Mapping):
        return {}, [], [f"vary is {quote(given)}: give a mapping from names to (low, high)"]
    made, tried, wrong = dict[str, Draw](), dict[str, list[Any]](), list[str]()
    for name, how in given.items():
        bounds = plain(how, partial(in_si, name)) if isinstance(how, tuple) else how
        if callable(how):
            made[name] = how
        elif isinstance(how, tuple) and is_range(bounds):
            made[name], tried[name] = partial(_evenly, float(bounds[0]), float(bounds[1])), [*bounds]
        elif isinstance(how, list) and how:
            made[name], tried[name] = partial(_one_of, how), how
        else:
            ways = f"{RANGE}; a list to choose from, or a function of a numpy Generator"
            wrong.append(f"vary of {quote(name)} is {quote(how)}: {ways}")
    most = max(map(len, tried.values()), default=0)
    # the ends of every range, and every value of a list
    rounds = [{name: values[min(number, len(values) - 1)] for name, values in tried.items()} for number in range(most)]
    return made, rounds, wrong


def refuse_unfit(system: System, rounds: list[dict[str, Any]]) -> None:
    """ModelError where values do not fit the model."""
    for values in rounds:
        system.changed(values)


def _evenly(low: float, high: float, generator: np.random.Generator) -> float:
    return float(generator.uniform(low, high))


def _one_of(values: list[Any], generator: np.random.Generator) -> Any:
    return values[int(generator.integers(len(values)))]
