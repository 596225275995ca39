"""Names of numbers of a model: beside those of gradients `c1.pressure.values[2:]`, all ordinates but the first."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from clutchwork.base import UseError, dataclass
from clutchwork.gradients.parameters import parameters

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.gradients.parameters import Tunable

RANGE = re.compile(r"(?P<table>.+)\[(?P<first>\d*):(?P<last>\d*)\]")


@dataclass(frozen=True)
class TimeTable:
    """A table of a model over time."""

    stem: str
    times: tuple[Tunable, ...]
    values: tuple[Tunable, ...]


def numbers(system: System, name: Any) -> tuple[Tunable, ...]:
    """The numbers that a name stands for; UseError where there are none."""
    found = RANGE.fullmatch(name) if isinstance(name, str) else None
    if found is None:
        return parameters(system, [name])
    listed = parameters(system, [found["table"]])
    first, last = int(found["first"] or 1), int(found["last"] or len(listed))
    if not 1 <= first <= last <= len(listed):
        such = f"{found['table']}[1:{len(listed)}]"
        raise UseError("gradient", [f"{name}: there is no such range; they are counted from 1: {such}"])
    return listed[first - 1 : last]


def curve(system: System, stem: str) -> TimeTable:
    """The table of a name; UseError where it is none over time."""
    return TimeTable(stem, parameters(system, [f"{stem}.times"]), parameters(system, [f"{stem}.values"]))
