"""Gears of a trajectory: which elements were closed when, and what that made of the box."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from clutchwork.base.classes import dataclass
from clutchwork.results.stretches import stretches
from clutchwork.shifts.record import NEUTRAL

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.results.recorded import Recorded

# torque that counts as none, as a share of the largest one
NOTHING = 0.02
# a gear that is held for less is passed through [s]
SHORTEST = 0.3
# position above which a sleeve is in mesh
IN_MESH = 0.5


@dataclass(frozen=True)
class InGear:
    """A stretch of a run in which one gear is in; "N": none, and no element that slips carries torque."""

    gear: str
    begin: float  # s
    end: float  # s


class Closed(NamedTuple):
    """A stretch of a run in which the same shift elements are closed."""

    begin: float  # s
    end: float  # s
    names: frozenset[str]


def gears_of(run: Recorded, box: Gearbox, prefix: str = "gearbox", *, least: float = SHORTEST) -> list[InGear]:
    """When which gear was in, by the elements that were locked and the dog clutches that were in mesh.

    Between gears the box is in neutral where nothing that slips carries torque, for `least` at least; a shift in which
    the input flies free to its new speed is none, for what both gears share stays closed, nor is a gear whose freewheel
    overruns.

    Parameters: least, time [s] for which a gear must be held, but for the first one and the last one.
    """
    parts = list(closed_of(run, box, prefix))
    known = {names: gear_with(box, names) for names in {part.names for part in parts}}
    found = list(_joined(InGear(known[part.names], part.begin, part.end) for part in parts))
    if not found:
        return []
    ends = (found[0].begin, found[-1].end)
    held = [one for one in found if one.gear and (one.end - one.begin >= least or one.begin in ends or one.end in ends)]
    idle = _idle(run, box, prefix, parts, held, least)
    return list(_joined(iter(sorted([*held, *idle], key=lambda one: one.begin))))


def closed_of(run: Recorded, box: Gearbox, prefix: str) -> Iterator[Closed]:
    """Which shift elements were closed when: contacts that are locked, dog clutches that are in mesh."""
    names = {f"{prefix}.{element.name}": element.name for element in box.elements}
    dogs = [name for path, name in names.items() if f"{path}.sleeve" in run]
    first = 0
    for part in stretches(run):
        locked = frozenset(names[name] for name in part.locked if name in names)
        if not dogs:
            yield Closed(part.begin, part.end, locked)
            continue
        rows = slice(first, part.last + 1)
        sleeves = np.array([part.run[f"{prefix}.{name}.sleeve"][rows] > IN_MESH for name in dogs])
        cuts = np.flatnonzero(np.any(sleeves[:, 1:] != sleeves[:, :-1], axis=0)) + 1
        times = [part.begin, *part.run.time[rows][cuts].tolist(), part.end]
        for (begin, end), place in zip(pairwise(times), [0, *cuts], strict=True):
            meshed = frozenset(name for name, inside in zip(dogs, sleeves[:, place], strict=True) if inside)
            yield Closed(begin, end, locked | meshed)
        first = part.last + 1


def gear_with(box: Gearbox, locked: frozenset[str]) -> str:
    """The gear whose elements are locked and whose ratio holds, empty where there is none."""
    ratio = box.combination(sorted(locked)).ratio
    if ratio is None:
        return ""
    fitting = [gear for gear in box.gears if set(box.closed_in(gear)) <= locked]
    return next((gear for gear in fitting if box.combination(box.closed_in(gear)).ratio == ratio), "")


def _joined(parts: Iterator[InGear]) -> Iterator[InGear]:
    """Stretches of one gear that follow one another are one; those of no duration are passed through."""
    last: InGear | None = None
    for part in parts:
        if last is not None and part.end <= part.begin and part.gear != last.gear:
            continue
        if last is not None and last.gear == part.gear:
            last = InGear(last.gear, last.begin, part.end)
            continue
        if last is not None:
            yield last
        last = part
    if last is not None:
        yield last


def _idle(
    run: Recorded, box: Gearbox, prefix: str, parts: Sequence[Closed], gears: Sequence[InGear], least: float
) -> list[InGear]:
    """Neutral before, between and behind gears."""
    time, found = np.asarray(run.time), []
    ends = [float(time[0]), *(at for one in gears for at in (one.begin, one.end)), float(time[-1])]
    around = [None, *gears, None]
    free: NDArray[np.bool_] | None = None
    for number, (old, new) in enumerate(pairwise(around)):
        begin, end = ends[2 * number], ends[2 * number + 1]
        if end - begin < least or (old and new and _flies(box, parts, old, new)):
            continue
        free = _free(run, box, prefix, parts) if free is None else free
        inside = np.flatnonzero((time >= begin) & (time <= end))
        cuts = np.flatnonzero(np.diff(free[inside].astype(int))) + 1
        idle = (part for part in np.split(inside, cuts) if len(part) and free[part[0]])
        spans = [(float(time[part[0]]), float(time[part[-1]])) for part in idle]
        found += [InGear(NEUTRAL, first, last) for first, last in spans if last - first >= least]
    return found


def _flies(box: Gearbox, parts: Sequence[Closed], old: InGear, new: InGear) -> bool:
    """Whether what two gears share stayed closed between them, freewheels left aside."""
    shared = {*box.closed_in(old.gear)} & {*box.closed_in(new.gear)}
    shared = {name for name in shared if box.element(name).kind != "freewheel"}
    between = [part.names for part in parts if old.end <= part.begin and part.end <= new.begin]
    return all(shared <= names for names in between)


def _free(run: Recorded, box: Gearbox, prefix: str, parts: Sequence[Closed]) -> NDArray[np.bool_]:
    """Where no element that slips carries torque."""
    time = np.asarray(run.time)
    free = np.ones(len(time), dtype=bool)
    for element in box.elements:
        torque = np.abs(run[f"{prefix}.{element.name}.torque"])
        carries = torque > NOTHING * float(np.max(torque, initial=0.0))
        for part in parts:
            if element.name in part.names:
                carries[(time > part.begin) & (time < part.end)] = False
        free &= ~carries
    return free
