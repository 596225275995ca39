"""One System with other numbers for each of many runs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base.errors import UseError
from clutchwork.base.quote import quote
from clutchwork.sweeps.factors import refuse_factors

if TYPE_CHECKING:
    from clutchwork.assembly.system import System


def systems_of(system: System, vary: object, count: int) -> list[System]:
    """The System of each run; equal values have one.

    Parameters: vary, `count` values by name, as `System.changed` takes them. UseError and ModelError say what is wrong.
    """
    columns, problems = dict[str, list[Any]](), list[str]()
    if not isinstance(vary, Mapping):
        raise UseError("cw.Simulators", [f"vary is {quote(vary)}: give a mapping from names to {count} values each"])
    refuse_factors("cw.Simulators", vary.items())
    for name, given in vary.items():
        values = given.tolist() if isinstance(given, np.ndarray) else given
        if not isinstance(values, list | tuple) or len(values) != count:
            length = f"{len(values)} values" if isinstance(values, list | tuple) else quote(given)
            problems.append(f"vary of {quote(name)} has {length}: give {count} values, one for each run")
        else:
            columns[name] = list(values)
    if problems:
        raise UseError("cw.Simulators", problems)
    if not columns:
        return [system] * count
    made: dict[tuple[Any, ...], System] = {}
    found = list[Any]()
    for line in zip(*columns.values(), strict=True):
        key = tuple(one if isinstance(one, int | float | str | bool) else id(one) for one in line)
        if key not in made:
            made[key] = system.changed(dict(zip(columns, line, strict=True)))
        found.append(made[key])
    return found
