"""Numbers of a driveline by which is differentiated: their names, where they stand, and the changes that set them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from math import inf
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.changes import UNKNOWN_SOURCE, owners_of
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError, UseError, advised
from clutchwork.base.quote import quote
from clutchwork.declare.node import Law, Signal
from clutchwork.declare.schema import common_ends
from clutchwork.model.changes import Owners, Target, changeable, field_of, named, target, targets_of, unit_of
from clutchwork.model.parts import held_positions

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.model.model import Model

Array = NDArray[np.float64]

# "c1.pressure.values[3]" or "c1.pressure.values[2:]": table, what of it, place from 1 on or a range with its ends
ENTRY = re.compile(r"(.+)\.(values|times|arguments)((?:\[\d+\])*|\[\d*:\d*\])")


@dataclass(frozen=True)
class Tunable:
    """One number."""

    name: str
    field: str  # what `System.changed` calls it, or the table that it stands in
    places: tuple[tuple[int, ...], ...]  # in the table, from 0 on; nothing where it is a number of its own
    unit: str
    start: float
    scale: float  # what a change of it is compared with
    lower: float = -inf  # what the declaration allows
    upper: float = inf
    reach: float = inf  # how far it is from its neighbours in a table
    unsized: bool = False  # zero without anything beside it that says how large it may be: its scale is one of its unit

    def compared(self, value: float) -> float:
        """What a change of it is compared with; 0 for one that has a size of its own: right beside zero none has."""
        beside_others = bool(self.places) or self.reach < inf
        return self.scale if beside_others or 0.0 in {self.start, value} else 0.0


class Unfit(Exception):  # noqa: N818, it is caught where it is raised
    """Why a name means no number to differentiate by."""


def parameters(system: System, by: Any) -> tuple[Tunable, ...]:
    """The numbers that names mean, in order; UseError names all that cannot be differentiated by.

    Parameters: by, a name or several, as in `System.changed`; of a table its ordinates by "c1.pressure.values", one of
    them, the third by "c1.pressure.values[3]", those from the second on by "c1.pressure.values[2:]", and times of its
    knots by "c1.pressure.times[3]".
    """
    if system.source is None:
        raise ModelError([UNKNOWN_SOURCE])
    listed = [by] if isinstance(by, str) else list(by) if isinstance(by, Iterable) else []
    if not listed:
        raise UseError("gradient", [f"by is {quote(by)}: name numbers, such as by=['c1.gain', 'engine.inertia']"])
    owners, found, problems = named(system.source), dict[str, Tunable](), list[str]()
    for name in listed:
        try:
            found |= {one.name: one for one in _meant(system.source, owners, name)}
        except Unfit as why:
            problems.append(str(why))
    if problems:
        raise UseError("gradient", problems)
    return tuple(found.values())


def _meant(model: Model, owners: Owners, name: Any) -> list[Tunable]:
    """The numbers of a name."""
    aim = target(owners, name)
    if aim is not None:
        _refuse_held(model, aim, name)
        return [_number(aim, name)]
    parts = ENTRY.fullmatch(name) if isinstance(name, str) else None
    table = target(owners, parts[1]) if parts else None
    if parts is None or table is None:
        _refuse_bracket(owners, name)
        _, (problem,) = targets_of(model, [name])
        raise Unfit(problem)
    found, wanted = list(_entries(table, parts[1], parts[2])), f"{parts[1]}.{parts[2]}{parts[3]}"
    if ":" in parts[3]:
        return _range(found, parts[3], name)
    chosen = [one for one in found if not parts[3] or one.name == wanted]
    if not chosen:
        together = "; points of a jump move under the number of the first one" if parts[2] != "values" else ""
        raise Unfit(f"{name} is not there: entries are counted from 1, {found[0].name} to {found[-1].name}{together}")
    return chosen


def _refuse_bracket(owners: Owners, name: Any) -> None:
    """Refuse the number of an entry without what of the table it counts."""
    stem, bracket, rest = name.partition("[") if isinstance(name, str) else ("", "", "")
    aim = target(owners, stem) if bracket else None
    if aim is not None and ENTRY.fullmatch(meant := f"{stem}.values[{rest}"):
        raise Unfit(f"{name} is not a number of this driveline; did you mean {meant!r}?")


def _refuse_held(model: Model, aim: Target, name: str) -> None:
    """Refuse where a crank holds a mass that has no position of its own."""
    for element in model.elements:
        if id(aim.owner) in held_positions([element]) and aim.path == ("angle",):
            raise Unfit(
                f"{name} follows from {element.name}, which holds it; take numbers of {element.name} or its shaft"
            )


def _range(found: list[Tunable], given: str, name: str) -> list[Tunable]:
    """Entries from one to another, both with them."""
    begin, end = given[1:-1].split(":")
    first, last = int(begin or 1), int(end or len(found))
    if not 1 <= first <= last <= len(found):
        raise Unfit(f"{name} is not there: entries are counted from 1, [1:{len(found)}] are all")
    return found[first - 1 : last]


def _number(aim: Target, name: str) -> Tunable:
    value, spec = field_of(aim)
    if spec.flag or spec.choices or spec.whole:
        kind = "whole number" if spec.whole else "choice"
        raise Unfit(f"{name} is a {kind}, which has no derivative; sweep over it")
    if spec.fixed and not value:
        raise Unfit(f"{name} is 0, which leaves out a state, so it has no derivative; give it a value above 0")
    if isinstance(value, Signal) and list(changeable(value)) == ["value"]:
        value = vars(value)["value"]
    if not isinstance(value, Real):
        raise Unfit(f"{name} {_inside(value, name)}")
    start = float(value)
    if spec.what == "option" and aim.path[-1] == "tolerance" and not start:
        # contacts lock at the exact zero of their slip, which no value beside it does
        raise Unfit(f"{name} is 0, the exact zero of the slip, beside which there is another rule; give it a value")
    # between two bounds it is no larger than they are
    bound = max(map(abs, spec.ends))
    size = abs(start) or _size_beside(aim) or (bound if bound < inf else 0.0)
    return Tunable(name, name, (), unit_of(aim), start, size or 1.0, *spec.ends, unsized=not size)


def _size_beside(aim: Target) -> float:
    """What a change of a number at zero is compared with: the largest number of its signal with its unit, else 0."""
    around = Target(aim.owner, aim.path[:-1])
    signal = field_of(around)[0] if around.path else None
    if not isinstance(signal, Signal):
        return 0.0
    others = (Target(aim.owner, (*around.path, word)) for word in changeable(signal))
    alike = (field_of(one)[0] for one in others if unit_of(one) == unit_of(aim))
    return max((abs(float(one)) for one in alike if isinstance(one, Real)), default=0.0)


def _inside(value: Any, name: str) -> str:
    """Why something is not a number, and which numbers are inside of it."""
    if value is None:
        return advised("has no value", "give it one in the driveline")
    if isinstance(value, Signal) and "points" in changeable(value):
        return advised("is a table", f"take {name}.values, {name}.values[1] or {name}.times[1]")
    if isinstance(value, Signal | Law) and changeable(value):
        kind, inside = type(value).__name__, ", ".join(f"{name}.{word}" for word in changeable(value))
        return advised(f"is a {kind}", f"take {inside}")
    if hasattr(value, "__len__") and not isinstance(value, str):
        return advised("is a table", f"take {name}.values or {name}.values[1]")
    return advised(f"is {quote(value)}, which is not a number", "give it a number in the driveline")


def _entries(table: Target, name: str, which: str) -> Iterator[Tunable]:
    """Ordinates or abscissae of a table, or the numbers of a list."""
    field, (value, spec) = name, field_of(table)
    declared = [spec]
    if isinstance(value, Signal) and "points" in changeable(value):
        table, field = Target(table.owner, (*table.path, "points")), f"{name}.points"
        value, spec = field_of(table)
        declared.append(spec)
    if spec.what not in ("curve", "numbers") or not hasattr(value, "__len__"):
        raise Unfit(f"{name} is {quote(value)}, which is not a table; take {name} itself")
    abscissae = "" if spec.what == "numbers" else "times" if spec.unit_x == "s" else "arguments"
    if which not in ("values", abscissae):
        raise Unfit(f"{name} has no {which}; take {name}.values{abscissae and f' or {name}.{abscissae}'}")
    found: list[tuple[str, tuple[tuple[int, ...], ...], float]]
    if spec.what == "numbers":
        found = [(_words(place), (place,), one) for place, one in _numbers(value)]
        unit = unit_of(table)
    elif which == "values":
        found = [(_words((i,)), ((i, 1),), float(point[1])) for i, point in enumerate(value)]
        unit = unit_of(table)
    else:
        found, unit = list(_knots(value)), spec.unit_x
    gaps = np.diff([one for _, _, one in found]) if which == abscissae else np.zeros(0)
    bounds = common_ends(declared) if which == "values" else (-inf, inf)
    reach, size = float(np.min(gaps, initial=inf)), max(abs(one) for _, _, one in found)
    for words, places, one in found:
        yield Tunable(f"{name}.{which}{words}", field, places, unit, one, size or 1.0, *bounds, reach, unsized=not size)


def _knots(points: Any) -> Iterator[tuple[str, tuple[tuple[int, ...], ...], float]]:
    """Abscissae of a table; points of a jump move together, under the number of the first one."""
    for x, jump in groupby(enumerate(points), key=lambda entry: float(entry[1][0])):
        numbers = [i for i, _ in jump]
        yield _words(numbers[:1]), tuple((i, 0) for i in numbers), x


def _numbers(value: Any) -> Iterator[tuple[tuple[int, ...], float]]:
    """Numbers of a list, or of rows of equally many, with their places."""
    for i, row in enumerate(value):
        if hasattr(row, "__len__"):
            yield from (((i, j), float(one)) for j, one in enumerate(row))
        else:
            yield (i,), float(row)


def _words(place: Sequence[int]) -> str:
    return "".join(f"[{number + 1}]" for number in place)


def changes(system: System, chosen: Sequence[Tunable], x: Array) -> dict[str, Any]:
    """What `System.changed` is given for the values of parameters."""
    made = dict[str, Any]()
    for one, value in zip(chosen, x.tolist(), strict=True):
        aim = target(owners_of(system), one.field) if one.places and one.field not in made else None
        if aim is not None:
            made[one.field] = _lists(field_of(aim)[0])
        for place in one.places or ((),):
            row: Any = made
            for step in (one.field, *place)[:-1]:
                row = row[step]
            row[(one.field, *place)[-1]] = value
    return made


def _lists(value: Any) -> Any:
    """A table as lists that may be written to."""
    return [_lists(row) for row in value] if hasattr(value, "__len__") else float(value)
