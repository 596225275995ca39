"""Why a shift was harsh: what happened, when, and which setting cures it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.shifts.comfort import jerk
from clutchwork.shifts.given import prefix_of, refuse_unfit
from clutchwork.shifts.record import NEUTRAL, Finding
from clutchwork.shifts.tie_up import opposing

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.shifts.metrics import ShiftQuality
    from clutchwork.shifts.record import ShiftRecord

STEP = 1e-3  # s
# from which on something is worth to be said: rad/s, share of the torque of an element, of that of the output
RUN_AWAY, AGAINST, STEPS, RINGS = 5.0, 0.05, 0.2, 0.1
# time around the end of the inertia phase in which a torque steps, and around the largest jerk [s]
BESIDE, NEAR = 0.03, 0.06
# time within which a gear that is left again hunts [s]
HUNTS = 3.0


@dataclass(frozen=True)
class _Seen:
    """A shift and its signals at equal steps around it."""

    box: Gearbox
    prefix: str
    one: ShiftQuality
    time: Array
    part: Any
    torque: Array | None
    unit: str  # of the torque

    def inside(self, begin: float, end: float) -> NDArray[np.bool_]:
        found: NDArray[np.bool_] = (self.time >= begin - 1e-9) & (self.time <= end + 1e-9)
        return found


def diagnose(
    run: Any, box: Gearbox, one: ShiftQuality, prefix: str = "", *, torque: str = "", acceleration: str = ""
) -> tuple[Finding, ...]:
    """Why a shift was harsh: the cause of its largest jerk first.

    Use it where a shift is harsh, whatever controlled it: each finding has its instant, its cause in numbers, and the
    settings of `ShiftSettings` that cure it. A shift that was smooth has none.

    Parameters: run, one, a shift of it; torque and acceleration, signals as of `cw.shifts.qualities`.
    """
    prefix = prefix_of(run, box, prefix)
    refuse_unfit("cw.shifts.diagnose", run, torque, acceleration)
    shift = one.shift
    first, last = max(float(run.time[0]), shift.begin - 0.4), min(float(run.time[-1]), shift.end + 0.6)
    time = np.arange(first, last, STEP)
    part = run.at(time)
    seen = _Seen(
        box,
        prefix,
        one,
        time,
        part,
        np.asarray(part[torque]) if torque else None,
        run.units[torque] if torque else "N m",
    )
    found = [*_runs_away(seen), *_ties_up(run, seen), *_let_go(run, seen), *_locks(seen), *_rings(seen)]
    speed = acceleration.removesuffix("acceleration") + "speed"
    if not acceleration or speed not in run:
        return tuple(sorted(found, key=lambda finding: finding.time))
    sizes = np.abs(jerk(np.asarray(part[speed]), STEP))
    worst = float(time[int(np.argmax(sizes))])
    # what is beside the largest jerk comes first
    return tuple(sorted(found, key=lambda finding: (abs(finding.time - worst) > NEAR, finding.time)))


def explain(record: ShiftRecord, findings: Sequence[Finding], later: Sequence[ShiftRecord] = ()) -> ShiftRecord:
    """The record with its diagnosis; later, records that follow, by which hunting is seen."""
    back = next((one for one in later if one.after == record.before and one.before == record.after), None)
    made = [*record.diagnosis, *findings]
    if back is not None and record.end is not None and back.begin - record.end < HUNTS:
        cause = f"{record.after} is left again for {record.before} after {back.begin - record.end:.2g} s: gears hunt"
        made.append(Finding(back.begin, cause, "lines of the shift map further apart"))
    return replace(record, diagnosis=tuple(made))


def _runs_away(seen: _Seen) -> Iterator[Finding]:
    """Flare and sag: nothing held the input."""
    one, box, shift = seen.one, seen.box, seen.one.shift
    speed, output = (np.asarray(seen.part[f"{seen.prefix}.{name}.speed"]) for name in (box.input, box.output))
    first = box.ratios[shift.before] if shift.before != NEUTRAL else box.ratios[shift.after]
    both = np.array([first * output, box.ratios[shift.after] * output])
    inside = seen.inside(shift.begin, shift.end)
    for size, beyond, word in (
        (one.flare, speed - both.max(axis=0), "above"),
        (one.sag, both.min(axis=0) - speed, "below"),
    ):
        if size > RUN_AWAY:
            at = float(seen.time[int(np.argmax(np.where(inside, beyond, -np.inf)))])
            names = "+".join(shift.closes)
            early = at <= shift.inertia_phase[0] + 0.5 * shift.inertia_time
            cause = f"the input ran {size:.0f} rad/s {word} both gears: {names} carried too little, too late"
            cure = "fill_time up, margin up" if early else "proportional up, torque_time down"
            yield Finding(at, cause, cure)


def _ties_up(run: Any, seen: _Seen) -> Iterator[Finding]:
    """An element that opens works against the one that closes."""
    shift = seen.one.shift
    for name in shift.opens:
        values = np.asarray(seen.part[f"{seen.prefix}.{name}.torque"])
        time, against = opposing(run, shift, f"{seen.prefix}.{name}", seen.time, values)
        worst = int(np.argmax(against)) if len(against) else -1
        if worst >= 0 and against[worst] > max(AGAINST * float(np.max(np.abs(values))), 10.0):
            cause = f"{name} held {against[worst]:.0f} N m against {'+'.join(shift.closes)}: a tie-up"
            yield Finding(float(time[worst]), cause, "fill_time down, margin down, torque_time up")


def _locks(seen: _Seen) -> Iterator[Finding]:
    """The torque of the output steps where the speeds meet: what the input gave up is gone."""
    shift, torque = seen.one.shift, seen.torque
    if torque is None or not shift.inertia_time:
        return
    at = shift.inertia_phase[1]
    before, behind = seen.inside(at - BESIDE, at), seen.inside(at, at + 2.0 * BESIDE)
    if not np.any(before) or not np.any(behind):
        return
    step = float(np.ptp(torque[behind]))
    level = float(np.max(np.abs(torque)))
    if step > STEPS * level:
        up = abs(seen.box.ratios.get(shift.before, np.inf)) > abs(seen.box.ratios[shift.after])
        cause = f"{'+'.join(shift.closes)} locked with a step of {step:.0f} {seen.unit} at the output"
        yield Finding(at, cause, "inertia_time up, reduction up" if up else "inertia_time up, stretch up")


def _let_go(run: Any, seen: _Seen) -> Iterator[Finding]:
    """Contacts beside the gearbox that break away meanwhile: a lock-up clutch, a tyre, a wheel."""
    shift = seen.one.shift
    for branch in run.wiring.contacts:
        name = branch.name
        if name.startswith(f"{seen.prefix}.") or f"{name}.state" not in run:
            continue
        states = np.asarray(seen.part[f"{name}.state"])
        locked = states == "locked"
        gone = np.flatnonzero(locked[:-1] & ~locked[1:])
        inside = [float(seen.time[n + 1]) for n in gone if shift.begin - 0.1 <= seen.time[n + 1] <= shift.end]
        if inside:
            cause = f"{name} let go during the shift"
            yield Finding(inside[0], cause, f"less torque at {name} (reduction up), or open it before the shift")


def _rings(seen: _Seen) -> Iterator[Finding]:
    """What rings behind the shift, with its frequency."""
    torque, end = seen.torque, seen.one.shift.end
    if torque is None:
        return
    rest = seen.inside(end + 0.1, end + 0.6)
    values = torque[rest]
    if len(values) < 200:
        return
    trend = values - np.polyval(np.polyfit(seen.time[rest], values, 2), seen.time[rest])
    size = 0.5 * float(np.ptp(trend))
    if size > RINGS * float(np.max(np.abs(torque))):
        crossings = seen.time[rest][:-1][np.diff(np.sign(trend)) != 0.0]
        frequency = 0.5 * (len(crossings) - 1) / max(float(np.ptp(crossings)), STEP) if len(crossings) else 0.0
        cause = f"the drive shaft rings with {size:.0f} {seen.unit} at {frequency:.1f} Hz behind the shift"
        cure = f"inertia_time near a multiple of {1.0 / frequency:.2g} s, end_time up" if frequency else "end_time up"
        yield Finding(float(end + 0.1), cause, cure)
