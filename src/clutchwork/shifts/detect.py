"""Shifts found in a trajectory: gears between them, torque phase, inertia phase. docs/theory/shifts.md (8)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.results.recorded import Recorded
from clutchwork.shifts.gears import InGear, gears_of
from clutchwork.shifts.given import prefix_of
from clutchwork.shifts.record import NEUTRAL

# torque that counts as none, as a share of the largest one
NOTHING = 0.02


@dataclass(frozen=True)
class Shift:
    """A shift as a trajectory shows it; instants in s.

    The inertia phase is from the last instant at which the old ratio holds to the first one of the new ratio. The
    torque phase is when both elements carry torque while one of both ratios holds: before the inertia phase or after
    it. `begin` is when the element that closes begins to carry torque, or the one that opens lets go. Out of neutral,
    where `before` is "N", there is no torque phase, and the inertia phase begins when an element begins to carry
    torque.
    """

    before: str
    after: str
    opens: tuple[str, ...]
    closes: tuple[str, ...]
    begin: float
    torque_phase: tuple[float, float]
    inertia_phase: tuple[float, float]
    end: float

    @property
    def torque_time(self) -> float:
        """Duration of the torque phase [s]."""
        return self.torque_phase[1] - self.torque_phase[0]

    @property
    def inertia_time(self) -> float:
        """Duration of the inertia phase [s]."""
        return self.inertia_phase[1] - self.inertia_phase[0]

    @property
    def time(self) -> float:
        """Duration of the whole shift [s]."""
        return self.end - self.begin


def shifts_of(run: Recorded, box: Gearbox, prefix: str = "") -> list[Shift]:
    """Every shift from one gear to another that a run shows, and from neutral into a gear; not those into neutral.

    Parameters: prefix, name of the Transmission, which may be left out where it is the only one.
    """
    prefix = prefix_of(run, box, prefix)
    gears = gears_of(run, box, prefix)
    made = []
    for number, (old, new) in enumerate(pairwise(gears)):
        if new.gear == NEUTRAL:
            continue
        first = gears[number - 1].end if number else float(run.time[0])
        made.append(_shift(run, box, prefix, (old, new), max(first, old.begin)))
    return made


def _shift(run: Recorded, box: Gearbox, prefix: str, gears: tuple[InGear, InGear], earliest: float) -> Shift:
    old, new = gears
    before = () if old.gear == NEUTRAL else box.closed_in(old.gear)
    after = box.closed_in(new.gear)
    opens = tuple(name for name in before if name not in after)
    closes = tuple(name for name in after if name not in before)
    time = np.asarray(run.time)
    on = _carries(run, [f"{prefix}.{name}" for name in closes], (old.begin, new.end))
    if old.gear == NEUTRAL:
        begin, end = _last_run(time, on, old.begin, new.begin)
        return Shift(old.gear, new.gear, opens, closes, begin, (begin, begin), (begin, end), end)
    off = _carries(run, [f"{prefix}.{name}" for name in opens], (old.begin, new.end))
    ahead = _last_run(time, on, earliest, old.end)
    behind = _first_run(time, off, new.begin, new.end)
    # two phases with nothing between: the longer one is the hand-over
    torque = ahead if ahead[1] - ahead[0] >= behind[1] - behind[0] else behind
    # where both carry torque on either side it is all of that
    begin, end = min(ahead[0], torque[0], old.end), max(torque[1], behind[1], new.begin)
    return Shift(old.gear, new.gear, opens, closes, begin, torque, (old.end, new.begin), end)


def _carries(run: Recorded, names: Sequence[str], window: tuple[float, float]) -> NDArray[np.bool_]:
    """Where any of some elements carries torque."""
    time = np.asarray(run.time)
    carried = np.zeros(len(time), dtype=bool)
    inside = (time >= window[0]) & (time <= window[1])
    for name in names:
        torque = np.abs(run[f"{name}.torque"])
        most = float(np.max(torque[inside], initial=0.0))
        carried |= torque > NOTHING * most
    return carried


def _last_run(time: NDArray[np.float64], carried: NDArray[np.bool_], begin: float, end: float) -> tuple[float, float]:
    """The stretch of carrying that ends at a time."""
    inside = np.flatnonzero((time >= begin) & (time <= end))
    rest = inside[~carried[inside]]
    first = time[rest[-1]] if len(rest) else begin
    return (float(first), end) if len(inside) and carried[inside[-1]] else (end, end)


def _first_run(time: NDArray[np.float64], carried: NDArray[np.bool_], begin: float, end: float) -> tuple[float, float]:
    """The stretch of carrying that begins at a time."""
    inside = np.flatnonzero((time >= begin) & (time <= end))
    # the row at that instant may be its left limit
    rest = inside[~carried[inside]]
    last = time[rest[0]] if len(rest) else begin
    return (begin, float(last)) if len(rest) and last > begin else (begin, begin)
