"""Measured samples beside the curves of a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import FileError, UseError, quote
from clutchwork.declare.node import Signal
from clutchwork.plot.curves import Curve

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded

Group: TypeAlias = "tuple[bool, list[str]]"

REMEDY = "give a pair of arrays (time in s, values in SI), a cw.Column or cw.Table, or a pandas Series over time"


def samples(runs: Mapping[str, Recorded], given: Any, call: str) -> list[Curve]:
    """Samples by the name of the signal that was measured."""
    if given is None:
        return []
    if not isinstance(given, Mapping):
        raise UseError(call, [f"measured is {quote(given)}: give samples by signal, {{'c1.torque': (time, values)}}"])
    made, wrong = list[Curve](), list[str]()
    for name, data in given.items():
        # an unknown name raises with near ones
        run = next((run for run in runs.values() if name in run), next(iter(runs.values())))
        unit = run.channels[name].unit
        wrong += [f"measured {quote(name)}: {fault}" for fault in _unit_faults(data, unit)]
        found = _pair(data)
        if isinstance(found, str):
            wrong.append(f"measured {quote(name)}: {found}")
        else:
            made.append(Curve(name, f"{name}, measured", unit, *found, measured=True))
    if wrong:
        raise UseError(call, wrong)
    return made


def with_samples(groups: Sequence[Group], extra: Sequence[Curve]) -> list[Group]:
    """Signals by panel, and those that were measured and are not among them."""
    names = {name for _, group in groups for name in group}
    return [*groups, *((False, [curve.signal]) for curve in extra if curve.signal not in names)]


def _unit_faults(data: Any, unit: str) -> Iterator[str]:
    """A column whose head has a unit that is not that of the signal."""
    if isinstance(data, Signal):
        try:
            yield from (f"{message}; {remedy}" for _, message, remedy in data.unit_problems((unit,)))
        except FileError as error:
            yield str(error)


def _seconds(index: NDArray[Any]) -> NDArray[np.float64]:
    """Times of an index [s]; TypeError for dates, which are not since the start of a run."""
    if index.dtype.kind == "M":
        raise TypeError
    return np.asarray(index / np.timedelta64(1, "s") if index.dtype.kind == "m" else index, dtype=float)


def _pair(data: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]] | str:
    """Times and values, or what is wrong."""
    try:
        if isinstance(data, Signal):
            points = np.asarray(getattr(data, "points", ()), dtype=float)
            times, values = points.reshape(-1, 2).T
        elif hasattr(data, "index") and hasattr(data, "to_numpy"):
            times, values = _seconds(np.asarray(data.index)), np.asarray(data.to_numpy(), dtype=float)
        else:
            times, values = (np.asarray(part, dtype=float) for part in data)
    except FileError as error:
        return str(error)
    except (TypeError, ValueError):
        return f"is {quote(data)}; {REMEDY}"
    if times.ndim != 1 or times.shape != values.shape or not times.size:
        return f"has {times.size} times for {values.size} values; {REMEDY}"
    return times, values
