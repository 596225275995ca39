"""Which gear of a gearbox was in when, by the shift elements that are closed: `run.gears`."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import groupby, pairwise, product
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from clutchwork.base import UnknownName, columns, dataclass, html, listed, near, quote
from clutchwork.base.extras import need
from clutchwork.results.channels import LOCKED
from clutchwork.results.locked_intervals import in_full

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from clutchwork.assembly.system import System
    from clutchwork.declare.node import ShiftTable
    from clutchwork.results.recorded import Recorded

NEUTRAL = "neutral"
# position of a sleeve past the tips of the teeth: one that is blocked is there up to round-off
BEYOND = 1e-6
# torque of elements that counts as drag, as a share of what they carry mostly
DRAG = 0.01


@dataclass(frozen=True)
class GearStretch:
    """A stretch of a run in which one gear of a gearbox was in, or none.

    `gear` is its name in the shift table, "neutral" where no element carries torque, None while elements slip or others
    than those of a gear are closed.
    """

    begin: float  # s
    end: float  # s
    gear: str | None
    closed: tuple[str, ...]


class GearTable(Sequence[GearStretch]):
    """The gears of a gearbox over a run, in order of time; print it to read it."""

    def __init__(self, gearbox: str, stretches: Sequence[GearStretch]) -> None:
        """Stretches that follow each other."""
        self.gearbox = gearbox
        self._stretches = tuple(stretches)

    @overload
    def __getitem__(self, index: int) -> GearStretch: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[GearStretch]: ...
    def __getitem__(self, index: int | slice) -> GearStretch | Sequence[GearStretch]:
        return self._stretches[index]

    def __len__(self) -> int:
        return len(self._stretches)

    def __iter__(self) -> Iterator[GearStretch]:
        return iter(self._stretches)

    def at(self, time: float) -> str | None:
        """The gear at an instant [s]; where two stretches meet, that of the later one."""
        found = [one.gear for one in self if one.begin <= time <= one.end]
        return found[-1] if found else None

    @property
    def sequence(self) -> tuple[str, ...]:
        """The gears one after another, without what is between them."""
        return tuple(name for name, _ in groupby(one.gear for one in self if one.gear is not None))

    def _cells(self) -> Iterator[tuple[str, ...]]:
        start = len(self.gearbox) + 1
        for one in self:
            closed = " ".join(name[start:] for name in one.closed) or "-"
            yield f"{one.begin:.6f}", f"{one.end:.6f}", one.gear or "-", closed

    def __str__(self) -> str:
        """A table for reading."""
        return columns([("from s", "to s", f"gear of {self.gearbox}", "closed"), *self._cells()], right={0, 1})

    __repr__ = __str__

    def _repr_html_(self) -> str:
        """A table for a notebook."""
        return html.table(("from, s", "to, s", f"gear of {self.gearbox}", "closed"), self._cells(), right={0, 1})

    def to_pandas(self) -> Any:
        """A pandas DataFrame with one line for each stretch, times in s. Needs pandas."""
        pandas = need("pandas", "tables", "a table")
        lines = [(one.begin, one.end, one.gear, " ".join(one.closed)) for one in self]
        return pandas.DataFrame(lines, columns=("begin", "end", "gear", "closed"))


def table_of(system: System, name: str = "") -> ShiftTable:
    """The gearbox of a name, the only one by default; UnknownName, a KeyError, where there is none."""
    known = {table.name: table for table in system.gearboxes}
    if not name and len(known) == 1:
        return next(iter(known.values()))
    if name not in known:
        remedy = f"gearboxes are {listed(known)}" if known else "the model has no cw.Transmission"
        fault = f"no gearbox {quote(name)}{near(name, known, remedy)}" if name else f"no gearbox is named; {remedy}"
        raise UnknownName(fault)
    return known[name]


def gear_of(table: ShiftTable, closed: Collection[str]) -> str | None:
    """The gear whose elements are closed; a freewheel that holds or a gear that waits beside them changes nothing."""
    own = frozenset(closed).intersection(table.elements)
    fits = [
        gear
        for gear, row in table.gears.items()
        if own >= frozenset(row) and own - frozenset(row) <= {*table.freewheels, *table.waiting}
    ]
    return max(fits, key=lambda gear: len(table.gears[gear]), default=None)


def gears_of(run: Recorded, name: str = "") -> GearTable:
    """The gears of a gearbox over a run."""
    table = table_of(run.system, name)
    if not len(run):
        return GearTable(table.name, ())
    run = in_full(run)
    closed, busy = _closed(run, table), _busy(run, table)
    cuts = [0, *(np.flatnonzero(np.any(closed[1:] != closed[:-1], axis=1)) + 1), len(run)]
    found = list[GearStretch]()
    begin = float(run.time[0])
    for first, stop in pairwise(cuts):
        names = tuple(name for name, held in zip(table.elements, closed[first], strict=True) if held)
        gear, end = gear_of(table, names), float(run.time[stop - 1])
        if table.ratios.get(gear or "") is None and gear not in table.gears:
            gear = None if np.any(busy[first:stop]) else NEUTRAL
        if end > begin or stop - first > 1:
            found.append(GearStretch(begin, end, gear, names))
        begin = end
    return GearTable(table.name, found)


def _closed(run: Recorded, table: ShiftTable) -> NDArray[np.bool_]:
    """Which elements are closed at each instant: locked, or in mesh."""
    return np.column_stack([_holds(run, name) for name in table.elements]) if table.elements else _none(run)


def _holds(run: Recorded, name: str) -> NDArray[np.bool_]:
    if f"{name}.mode" in run:
        return np.asarray(run[f"{name}.mode"] == LOCKED)
    # a synchroniser holds by the dog clutch behind its cone
    name = name if f"{name}.sleeve" in run else f"{name}.forward_dog"
    element: Any = next((one for one in run.system.elements if one.name == name), None)
    if f"{name}.sleeve" in run:
        return np.asarray(run[f"{name}.sleeve"] > element.reach + BEYOND)
    return np.zeros(len(run), dtype=bool)


def _none(run: Recorded) -> NDArray[np.bool_]:
    return np.zeros((len(run), 0), dtype=bool)


def _busy(run: Recorded, table: ShiftTable) -> NDArray[np.bool_]:
    """Whether any element carries more than drag at each instant."""
    torques = [np.abs(run[f"{name}.torque"]) for name in table.elements if f"{name}.torque" in run]
    most = np.max(torques, axis=0) if torques else np.zeros(len(run))
    # not the largest, which may be that of an impact
    usual = np.median(most[most > 0.0]) if np.any(most > 0.0) else 1.0
    return np.asarray(most > DRAG * usual)


def named_closed(system: System, closed: Collection[str]) -> str:
    """Closed contacts in words: gears by their names, others by their own."""
    rest, words = list(closed), list[str]()
    for table in system.gearboxes:
        gear = gear_of(table, closed)
        if gear is not None:
            words.append(f"{table.name}: {gear}")
            rest = [name for name in rest if name not in table.elements]
    return " ".join([*words, *rest]) or "-"


def rows_of(system: System) -> Iterator[tuple[str, ...]]:
    """Closed elements of every combination of gears of the gearboxes."""
    rows = [list(table.gears.values()) for table in system.gearboxes]
    return (tuple(dict.fromkeys(name for row in some for name in row)) for some in product(*rows))
