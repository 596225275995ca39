"""Signals whose knots the reader of a page drags: made tables, with room for more knots in the bytes of the System."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import isfinite
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.assembly.provenance import parameter
from clutchwork.assembly.records import frozen
from clutchwork.base import UseError, dataclass, near
from clutchwork.declare.node import Signal
from clutchwork.declare.schema import Role
from clutchwork.model.changes import SIGNALS, all_names, field_of, named, target, unit_of
from clutchwork.results.selection import meant
from clutchwork.run.control import controllers
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

Points = list[tuple[float, float]]

# tables that are dragged where nothing is asked for, plots of them; knots of one, and those that may be added
MOST_TABLES, MOST_PLOTS, MOST_KNOTS, MORE = 4, 2, 200, 8
# between pieces that no run reaches [s]
NEVER = 1e9


@dataclass(frozen=True)
class Dragged:
    """A table that is dragged."""

    name: str
    unit: str
    points: Points
    lower: float | None  # what its declaration allows
    upper: float | None
    inputs: tuple[int, ...]  # signals of the System that it is


def tables(system: System) -> dict[str, Points]:
    """Knots of all signals that are straight between knots, by name."""
    found = dict[str, Points]()
    if system.source is None:
        return found
    owners = named(system.source)
    for name in all_names(system.source):
        aim = target(owners, name)
        value, spec = field_of(aim) if aim else (None, None)
        if spec is not None and spec.what in SIGNALS and isinstance(value, Real) and not isinstance(value, bool):
            found[name] = [(0.0, float(value))]
        elif isinstance(value, Signal) and (points := knots_of(value)):
            found[name] = points
    return found


def knots_of(signal: Signal) -> Points:
    """The knots of a signal; nothing where it is not straight between knots, or has too many."""
    if type(signal).segments is Table.segments:
        points = [(float(x), float(y)) for x, y in vars(signal)["points"]]
        return points if len(points) <= MOST_KNOTS else []
    try:
        pieces = signal.segments()
    except NotImplementedError:
        return []
    if not pieces or signal.repeats() or len(pieces) > MOST_KNOTS or any(any(piece[3:]) for piece in pieces):
        return []
    made = list[tuple[float, float]]()
    for one, following in pairwise(pieces):
        end = one.c0 + one.c1 * (following.start - one.start)
        made += [(one.start, one.c0), (following.start, end)]
    last = pieces[-1]
    # the last piece rises for ever: no table does
    return [] if last.c1 else list(dict.fromkeys([*made, (last.start, last.c0)]))


def chosen(system: System, wanted: Sequence[str] | None, t_end: float) -> dict[str, Points]:
    """The tables that are dragged: those that are asked for, or pressures and the like that vary."""
    known = tables(system)
    if wanted is None:
        return _usual(system, known, t_end)
    found, problems = dict[str, Points](), list[str]()
    for one in wanted:
        names = meant(one, known)
        if not names:
            rest = "signals that are straight between knots: " + (", ".join(known) or "none")
            problems.append(f"drag: {one!r} cannot be dragged{near(one, known, rest)}")
        found.update({name: known[name] for name in names})
    if problems:
        raise UseError("page", problems)
    return {name: spread(points, t_end) for name, points in found.items()}


def _usual(system: System, known: dict[str, Points], t_end: float) -> dict[str, Points]:
    """Signals that vary within the run, pressures and what presses contacts first; else constant ones of contacts."""
    owners = named(system.source) if system.source else {}
    units = {name: _unit(owners, name) for name in known}
    pressing = {name for name in known if units[name] == "Pa" or _is_of_contact(owners, name)}
    varying = [name for name, points in known.items() if _varies(points, t_end)]
    ranked = sorted(varying, key=lambda name: (units[name] != "Pa", name not in pressing))
    if ranked and units[ranked[0]] == "Pa":
        ranked = [name for name in ranked if units[name] == "Pa"]
    ranked = ranked or sorted(pressing, key=list(known).index) or list(known)
    plots = list(dict.fromkeys(units[name] for name in ranked))[:MOST_PLOTS]
    return {name: spread(known[name], t_end) for name in [n for n in ranked if units[n] in plots][:MOST_TABLES]}


def _is_of_contact(owners: Any, name: str) -> bool:
    aim = target(owners, name)
    return getattr(aim.owner if aim else None, "role", None) is Role.CONTACT


def _unit(owners: Any, name: str) -> str:
    aim = target(owners, name)
    return unit_of(aim) if aim else ""


def _varies(points: Points, t_end: float) -> bool:
    return len({y for x, y in points if x <= t_end}) > 1


def spread(points: Points, t_end: float) -> Points:
    """At least two knots, so that there is something to drag."""
    return points if len(points) > 1 else [(0.0, points[0][1]), (t_end, points[0][1])]


def with_tables(system: System, wanted: dict[str, Points]) -> tuple[System, list[Dragged]]:
    """The System whose signals are these tables, and where they stand in it."""
    made = system.changed({name: Table(points) for name, points in wanted.items()}) if wanted else system
    found, problems = list[Dragged](), list[str]()
    for name, points in wanted.items():
        own = parameter(made, name)
        if not own.is_signal:
            problems.append(f"drag: {name} is not an independent signal in this driveline; drag another one")
            continue
        lower, upper = (bound if isfinite(bound) else None for bound in own.bounds)
        found.append(Dragged(name, own.unit, points, lower, upper, own.inputs))
    if problems:
        raise UseError("page", problems)
    return made, found


def roomy(system: System, dragged: Sequence[Dragged]) -> tuple[System, dict[int, int]]:
    """The System with room for more pieces of the signals that are dragged, and how many each has.

    What is not needed begins long after every run, with the last value.
    """
    room = {number: len(one.points) + 1 + MORE for one in dragged for number in one.inputs}
    arrays = dict(system.arrays)
    count, coefficients = arrays["input_count"].copy(), list[Any]()
    times = np.split(arrays["segment_time"], arrays["input_first"][1:]) if len(count) else []
    for number, starts in enumerate(times):
        here = int(arrays["input_first"][number])
        own = arrays["segment_coef"][here : here + len(starts)]
        more = room.get(number, len(starts)) - len(starts)
        times[number] = np.concatenate([starts, starts[-1:] + NEVER * np.arange(1, more + 1)])
        coefficients.append(np.concatenate([own, np.repeat(own[-1:], more, axis=0)]))
        count[number] = len(times[number])
    arrays |= {"input_count": count, "input_first": np.cumsum(count, dtype=count.dtype) - count}
    if times:
        arrays |= {"segment_time": np.concatenate(times), "segment_coef": np.concatenate(coefficients)}
    return replace(system, arrays=frozen(arrays)), room


def refuse_controllers(system: System) -> None:
    """A page has no Python: signals that a function gives cannot be in it."""
    names = [one.name for one in controllers(system.inputs)]
    if names:
        fault, remedy = "is given by a Python function, which no page can call", "give it a table"
        raise UseError("page", [f"{name} {fault}: {remedy}" for name in names])
