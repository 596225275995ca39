"""Gears of a trajectory that shifts lead from and to."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

import numpy as np

from clutchwork.base import dataclass
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.results import gears
from clutchwork.results.gears import GearStretch
from clutchwork.results.recorded import Recorded
from clutchwork.shifts.given import prefix_of
from clutchwork.shifts.record import NEUTRAL

# a gear that is held for less is passed through [s]
SHORTEST = 0.3
# torque that counts as none, as a share of what elements carry mostly
NOTHING = 0.02


@dataclass(frozen=True)
class InGear:
    """A stretch of a run in which one gear is in; "N": none, and no element carries torque."""

    gear: str
    begin: float  # s
    end: float  # s


def gears_of(run: Recorded, box: Gearbox, prefix: str = "", *, least: float = SHORTEST) -> list[InGear]:
    """The gears that a `cw.Transmission` was in, one after the other, without those that it only passed through.

    What `run.gears()` lists is put together: a gear whose elements let go for a moment stays one, and so does one whose
    freewheel overruns. Between gears the box is in neutral where no element carries torque for `least`, and something
    of what both gears share was open; a shift in which the input flies free to its new speed has no neutral.

    Parameters: prefix, name of the Transmission, which may be left out where it is the only one; least, time [s] for
    which a gear must be held, except the first one and the last one.
    """
    prefix = prefix_of(run, box, prefix)
    parts = list(gears.gears_of(run, prefix))
    if not parts:
        return []
    ends = {parts[0].begin, parts[-1].end}
    known = box.ratios
    named = list(_joined(InGear(part.gear if part.gear in known else "", part.begin, part.end) for part in parts))
    held = [one for one in named if one.gear and (one.end - one.begin >= least or {one.begin, one.end} & ends)]
    idle = list(_idle(run, box, prefix, list(_between(held, parts[0].begin, parts[-1].end)), least))
    used = [one for one in idle if not _flies(box, prefix, parts, held, one)]
    return list(_joined(sorted([*held, *used], key=lambda one: one.begin)))


def _between(held: Sequence[InGear], first: float, last: float) -> Iterator[tuple[float, float]]:
    """Stretches in which no gear is in [s]."""
    times = [first, *(at for one in held for at in (one.begin, one.end)), last]
    yield from zip(times[::2], times[1::2], strict=True)


def _idle(
    run: Recorded, box: Gearbox, prefix: str, gaps: Sequence[tuple[float, float]], least: float
) -> Iterator[InGear]:
    """Where no element carries torque."""
    long = [(begin, end) for begin, end in gaps if end - begin >= least]
    if not long:
        return
    time = np.asarray(run.time)
    most = np.max([np.abs(run[f"{prefix}.{element.name}.torque"]) for element in box.elements], axis=0)
    free = most <= NOTHING * float(np.median(most[most > 0.0])) if np.any(most > 0.0) else most <= 0.0
    for begin, end in long:
        inside = np.flatnonzero((time >= begin) & (time <= end))
        cuts = np.flatnonzero(np.diff(free[inside].astype(int))) + 1
        idle = (part for part in np.split(inside, cuts) if len(part) and free[part[0]])
        spans = [(float(time[part[0]]), float(time[part[-1]])) for part in idle]
        yield from (InGear(NEUTRAL, first, last) for first, last in spans if last - first >= least)


def _joined(parts: Iterable[InGear]) -> Iterator[InGear]:
    """Stretches of one gear that follow one another are one."""
    last: InGear | None = None
    for part in parts:
        if last is not None and last.gear == part.gear:
            last = InGear(last.gear, last.begin, part.end)
            continue
        if last is not None:
            yield last
        last = part
    if last is not None:
        yield last


def _flies(box: Gearbox, prefix: str, parts: Sequence[GearStretch], held: Sequence[InGear], idle: InGear) -> bool:
    """Whether what the gears on both sides share stayed closed, freewheels left aside."""
    for old, new in pairwise(held):
        if old.end <= idle.begin and idle.end <= new.begin:
            shared = {*box.closed_in(old.gear)} & {*box.closed_in(new.gear)}
            wanted = {f"{prefix}.{name}" for name in shared if box.element(name).kind != "freewheel"}
            between = [part.closed for part in parts if old.end <= part.begin and part.end <= new.begin]
            return all(wanted <= {*closed} for closed in between)
    return False
