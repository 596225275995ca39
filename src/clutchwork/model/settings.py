"""The settings of a driveline's runs, as [simulation] of a model file: what is wrong with them, and as plain data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

from clutchwork.base import Problem, listed, near, quote
from clutchwork.declare.options import ONE_GRID, SIMULATION
from clutchwork.declare.schema import Spec
from clutchwork.declare.wording import say
from clutchwork.model.numbers import At, list_problems


def settings_problems(settings: Mapping[str, Any]) -> Iterator[Problem]:
    """Unknown names, values that make no sense, and two grids at once."""
    at = At(say("simulation", "d.simulation"), "")
    for name, value in settings.items():
        row, place = SIMULATION.get(name), at.inner(str(name))
        if row is None:
            yield place.problem(
                "is an unknown key" + near(name, SIMULATION), remedy=f"known keys: {listed(SIMULATION)}"
            )
        elif row.spec.what == "numbers" and value is not None:
            yield from _instants(row.in_si(value), row.spec, at.inner(name, row.spec.unit))
        elif fault := row.fault(value):
            yield place.problem(fault.message, fault.value, fault.remedy)
    if settings.get("dt") is not None and settings.get("times") is not None:
        yield at.inner("times").problem("is given beside dt", quote(settings["times"]), ONE_GRID)


def _instants(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    """A list of numbers within the bounds that does not decrease."""
    found = list(list_problems(value, spec, at))
    yield from found
    if not found and any(hasattr(instant, "__len__") for instant in value):
        yield at.problem("must be a list of numbers", quote(value), f"write [x, y, ...]: {spec.doc}")
    elif not found and any(after < before for before, after in pairwise(value)):
        yield at.problem("must not decrease", quote(value), "sort the instants; one may be given twice")


def plain_settings(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Settings without mistakes in SI, as a model file holds them; what is None is left out."""
    return {name: _plain(SIMULATION[name].in_si(value)) for name, value in settings.items() if value is not None}


def _plain(value: Any) -> Any:
    if isinstance(value, str | bool | int):
        return value
    return [float(instant) for instant in value] if hasattr(value, "__len__") else float(value)
