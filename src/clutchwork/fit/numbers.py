"""Numbers of a driveline that are searched for: those of all records, and those that each record has for itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import inf, nextafter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError, dataclass, near
from clutchwork.base.arrays import Array
from clutchwork.fit.failure import FitError, refuse
from clutchwork.fit.unknown import Bounds, Pair, Unknown
from clutchwork.gradients.parameters import ENTRY, Tunable, parameters
from clutchwork.model.changes import all_names, named, target

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.fit.driven import Driven


# how far the search goes from a start value above zero where no bounds are given, as a factor
REACH = 1e3


@dataclass(frozen=True, eq=False)
class Numbers:
    """What is searched for, and which of it each record has."""

    items: tuple[Unknown, ...]
    shared: int  # the first ones, of all records
    by: tuple[str, ...]  # names in one record: shared ones, then its own
    scales: Array  # what a change of each code is measured in

    def places(self, record: int) -> NDArray[np.intp]:
        """Places of the numbers of a record among all."""
        own = len(self.by) - self.shared
        first = self.shared + record * own
        return np.array([*range(self.shared), *range(first, first + own)], dtype=np.intp)

    def values(self, u: Array) -> Array:
        """Decode the numbers that the search varies."""
        return np.array([item.decoded(float(code)) for item, code in zip(self.items, u, strict=True)])

    def codes(self) -> Array:
        """Codes of the start values."""
        return np.array([item.coded(item.start) for item in self.items])

    def ends(self) -> tuple[Array, Array]:
        """Ends of the search, as codes."""
        lower = [item.coded(item.lower) for item in self.items]
        return np.array(lower), np.array([item.coded(item.upper) for item in self.items])

    def rates(self, values: Array) -> Array:
        """Derivatives of the numbers by their codes."""
        return np.where([item.is_log for item in self.items], values, 1.0)


def numbers(records: Sequence[Driven], free: Sequence[str], own: Sequence[str], bounds: Bounds) -> Numbers:
    """The free numbers with their bounds; FitError names all that cannot be searched for."""
    shared = [name for name in free if name not in own]
    if _tunables(records[0].system, [*shared, *own])[1]:
        refuse(faults(records[0].system, [*shared, *own], bounds))
    count = len(parameters(records[0].system, shared)) if shared else 0
    found, problems = [list(parameters(one.system, [*shared, *own])) for one in records], list[FitError]()
    made = [_item(one, one.name, bounds, problems) for one in found[0][:count]]
    for record, all_of in zip(records, found, strict=True):
        of = f" ({record.label})" if len(records) > 1 else ""
        made += [_item(one, f"{one.name}{of}", bounds, problems) for one in all_of[count:]]
    problems += _not_free(found[0], bounds)
    samples = sum(len(one.times) for record in records for one in record.traces)
    if samples <= len(made):
        problems.append(FitError("samples", f"are {samples} for {len(made)} numbers", "record more of them"))
    refuse(problems)
    scales = [one.scale for one in (*found[0][:count], *(one for all_of in found for one in all_of[count:]))]
    sizes = np.array([1.0 if item.is_log else size for item, size in zip(made, scales, strict=True)])
    return Numbers(tuple(made), count, tuple(one.name for one in found[0]), sizes)


def faults(system: System, names: Sequence[str], bounds: Bounds) -> list[FitError]:
    """All that is wrong with names of free numbers, and with bounds, without a look at records."""
    found, problems = _tunables(system, names)
    for one in found:
        _item(one, one.name, bounds, problems)
    return [*problems, *_not_free(found, {name: pair for name, pair in bounds.items() if name not in names})]


def _tunables(system: System, names: Sequence[str]) -> tuple[list[Tunable], list[FitError]]:
    """The numbers that names mean, and what is wrong with the other names."""
    found, problems = list[Tunable](), list[FitError]()
    for name in names:
        unknown = _unknown(system, name)
        try:
            found += [] if unknown else parameters(system, [name])
        except UseError as error:
            told = (text.partition("; ") for text in error.problems)
            problems += [FitError("free", what, remedy or "name another number") for what, _, remedy in told]
        problems += [unknown] if unknown else []
    return found, problems


def _not_free(found: Sequence[Tunable], bounds: Bounds) -> Iterator[FitError]:
    """Bounds of what is not free."""
    known = {key for one in found for key in _keys(one.name)}
    for name in bounds:
        if name not in known:
            told = f"are given for {name!r}, which is not free{near(name, known)}"
            yield FitError("bounds", told, "free it, or take them out")


def _unknown(system: System, name: Any) -> FitError | None:
    """What is wrong with a name that leads nowhere."""
    if system.source is None:
        return None
    owners = named(system.source)
    parts = ENTRY.fullmatch(name) if isinstance(name, str) else None
    if target(owners, name) is not None or (parts is not None and target(owners, parts[1]) is not None):
        return None
    words = name.split(".") if isinstance(name, str) else []
    is_there = any(".".join(words[:cut]) in owners for cut in range(1, len(words)))
    like = near(name, all_names(system.source)) if is_there else near(words[0] if words else "", owners)
    return FitError("free", f"has no {name!r}{like}", 'name a number of an element, "c1.gain"')


def _keys(name: str) -> list[str]:
    """What bounds of a number may be given under: its name, or that of all entries of its table."""
    parts = ENTRY.fullmatch(name)
    return [name, f"{parts[1]}.{parts[2]}"] if parts else [name]


def _item(one: Tunable, name: str, bounds: Bounds, problems: list[FitError]) -> Unknown:
    given = next((bounds[key] for key in _keys(one.name) if key in bounds), (None, None))
    try:
        return _made(one, name, given)
    except FitError as error:
        problems.append(error)
        return replace(_made(one, name, (None, None)), start=one.start)


def _made(one: Tunable, name: str, given: Pair) -> Unknown:
    """A number that is searched for, by its logarithm where it is above zero and must not fall below."""
    try:
        low, high = (None if end is None else float(end) for end in given)
    except (TypeError, ValueError):
        raise FitError("bounds", f"of {name} are {given!r}", "give a pair: (lower, upper)") from None
    if low is not None and high is not None and low > high:
        raise FitError("bounds", f"of {name} are swapped: ({low:g}, {high:g})", f"give ({high:g}, {low:g})")
    is_given = low is not None or high is not None
    lowest = max(one.lower, -inf if low is None else low)
    highest = min(one.upper, inf if high is None else high)
    lower, upper = lowest, highest
    if one.start > 0.0 and lowest >= 0.0 and low != 0.0:
        lower, upper = max(lowest, one.start / REACH), min(highest, one.start * REACH)
        lower, upper = lower if low is None else lowest, upper if high is None else highest
    inside = lower < one.start < upper if is_given else lower <= one.start <= upper
    if not inside:
        fault = f"of {name} are {lowest:g} to {highest:g} [{one.unit}], its start value is {one.start:g}"
        raise FitError("bounds", fault, "start between them")
    words = f"{lowest:g} to {highest:g}" if is_given else _declared(one)
    return Unknown(name, one.unit, one.start, words, lower, upper, lowest, highest, one.field)


def _declared(one: Tunable) -> str:
    """Bounds of the declaration in words."""
    if one.upper < inf:
        return f"{one.lower:g} to {one.upper:g}"
    return "> 0" if one.lower == nextafter(0.0, inf) else f">= {one.lower:g}"
