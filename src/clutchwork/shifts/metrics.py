"""What a shift was like, in numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.results.felt import WINDOW
from clutchwork.results.recorded import Recorded
from clutchwork.shifts.comfort import jerk, vibration_dose
from clutchwork.shifts.detect import Shift, shifts_of
from clutchwork.shifts.given import prefix_of, refuse_unfit
from clutchwork.shifts.record import NEUTRAL
from clutchwork.shifts.tie_up import opposing

STEP = 1e-3  # s, of the grid that phases and jerk are looked at on
# how long a level of the torque is looked at, and how long the element that closes is filled before it carries [s]
LEVEL, FILLING = 0.2, 0.2


@dataclass(frozen=True)
class ShiftQuality:
    """One shift and what it was like.

    Parameters:
        shift: gears, elements and phases
        peak_jerk: largest jerk of the vehicle that is felt, its size [m/s3], of a shaft [rad/s3]; NaN where its
        acceleration is not known
        rms_jerk: root of the mean of its square, from 0.4 s before the begin to half a second behind the end
        vibration_dose: vibration dose value of the same stretch [m/s1.75]
        torque_hole: how far the torque of the output falls below the lower one of its levels before and after, in N m
        hole_share: the same over its level before; NaN out of neutral
        flare: how far the input runs above the speeds of both gears [rad/s], out of neutral above that of its start
        sag: how far it falls below both [rad/s]
        tie_up: largest torque with which an element that opens works against its direction in the old gear [N m]
        slip_energy: heat that each element made [J]
        slip_power: largest heat rate of each element [W]
        temperature: highest of the thermal node of each element that has one [K]
        jerk_unit, torque_unit: of the jerks, "m/s3" or "rad/s3", and of the hole, "N m" or "N"
    """

    shift: Shift
    peak_jerk: float
    rms_jerk: float
    vibration_dose: float
    torque_hole: float
    hole_share: float
    flare: float
    sag: float
    tie_up: float
    slip_energy: Mapping[str, float]
    slip_power: Mapping[str, float]
    temperature: Mapping[str, float]
    jerk_unit: str = "m/s3"
    torque_unit: str = "N m"

    @property
    def dose_unit(self) -> str:
        """Unit of the vibration dose value: that of the acceleration, times the fourth root of a second."""
        return self.jerk_unit.replace("s3", "s1.75")


def qualities(
    run: Any,
    box: Gearbox,
    prefix: str = "",
    *,
    torque: str = "",
    acceleration: str = "",
    window: float = WINDOW,
    after: float = 0.5,
) -> list[ShiftQuality]:
    """What every shift of a run was like.

    Parameters: prefix, name of the Transmission, which may be left out where it is the only one; torque, signal of the
    torque behind the output [N m], such as that of a drive shaft, or of a force [N]; acceleration, signal of the
    vehicle [m/s2] or of a shaft [rad/s2], whose speed is asked for its jerk; window, over which a jerk is felt [s], at
    least 2 ms; after, time behind a shift that belongs to it [s]. docs/theory/shifts.md (9)

    UseError for signals in other units, UnknownName, a KeyError, for those that are not there.
    """
    prefix = prefix_of(run, box, prefix)
    refuse_unfit("cw.shifts.qualities", run, torque, acceleration)
    shifts = shifts_of(run, box, prefix)
    if not shifts:
        return []
    begins = [*(shift.begin for shift in shifts[1:]), float(run.time[-1])]
    ends = [float(run.time[0]), *(shift.end for shift in shifts)]
    grids = [
        _grid(shift, max(shift.begin - FILLING - LEVEL, first), min(shift.end + after, last))
        for shift, first, last in zip(shifts, ends, begins, strict=False)
    ]
    # one repetition of the run for all of them
    whole = run.at(np.unique(np.concatenate(grids)))
    columns: dict[str, Array] = {}
    windows = [Window(whole, columns, np.searchsorted(whole.time, grid)) for grid in grids]
    return [
        _quality(run, part, shift, box, prefix, torque, acceleration, window)
        for part, shift in zip(windows, shifts, strict=True)
    ]


def _grid(shift: Shift, first: float, last: float) -> Array:
    """Equal steps around a shift, between two times, and its ends [s]; the ends are the last two."""
    steps = np.arange(first, last, STEP)
    return np.array([*steps[steps <= last], shift.begin, shift.end])


class Window:
    """Signals of a run at equal steps around one shift, and at its ends."""

    def __init__(self, run: Recorded, columns: dict[str, Array], rows: NDArray[np.intp]) -> None:
        """Rows of the run, of which the last two are the ends of the shift; columns that windows share."""
        self.run, self.columns, self.rows = run, columns, rows
        self.time = np.asarray(run.time)[rows[:-2]]

    def __getitem__(self, name: str) -> Array:
        return self._whole(name)[self.rows[:-2]]

    def __contains__(self, name: str) -> bool:
        return name in self.run

    def rise(self, name: str) -> float:
        """How much a signal grows from begin to end of the shift."""
        first, last = self._whole(name)[self.rows[-2:]]
        return float(last - first)

    def _whole(self, name: str) -> Array:
        if name not in self.columns:
            self.columns[name] = np.asarray(self.run[name])
        return self.columns[name]


def _speed(part: Window, acceleration: str) -> Array:
    """The speed whose rate an acceleration is, from where it begins; that of a sensor is integrated."""
    speed = acceleration.removesuffix("acceleration") + "speed"
    if acceleration.endswith(".acceleration") and speed in part:
        return part[speed]
    values = part[acceleration]
    return np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * STEP)])


def _quality(
    run: Any,
    part: Window,
    shift: Shift,
    box: Gearbox,
    prefix: str,
    torque: str,
    acceleration: str,
    window: float,
) -> ShiftQuality:
    time = part.time
    inside = (time >= shift.begin) & (time <= shift.end)
    jerks = jerk(_speed(part, acceleration), STEP, window=window) if acceleration else np.array([np.nan])
    dose = vibration_dose(part[acceleration], STEP) if acceleration else float("nan")
    hole, share = _hole(part[torque], time, shift) if torque else (float("nan"), float("nan"))
    flare, sag = _overshoot(part, shift, box, prefix, inside)
    # a dog clutch makes none that is counted
    names = [element.name for element in box.elements if f"{prefix}.{element.name}.heat" in part]
    return ShiftQuality(
        shift=shift,
        peak_jerk=float(np.max(np.abs(jerks))),
        rms_jerk=float(np.sqrt(np.mean(jerks**2))),
        vibration_dose=dose,
        torque_hole=hole,
        hole_share=share,
        flare=flare,
        sag=sag,
        tie_up=_tie_up(run, part, shift, prefix),
        slip_energy={name: part.rise(f"{prefix}.{name}.heat") for name in names},
        slip_power={name: _peak(part, f"{prefix}.{name}", inside) for name in names},
        temperature=_temperatures(part, prefix, names),
        jerk_unit=run.units[acceleration].replace("s2", "s3") if acceleration else "m/s3",
        torque_unit=run.units[torque] if torque else "N m",
    )


def _peak(part: Window, name: str, inside: NDArray[np.bool_]) -> float:
    return float(np.max(np.abs(part[f"{name}.torque"] * part[f"{name}.slip"])[inside], initial=0.0))


def _hole(torque: Array, time: Array, shift: Shift) -> tuple[float, float]:
    """How far the torque of the output falls below the lower of its levels before and after, while it rings too."""
    shifts = time >= shift.begin - FILLING
    rests = time > max(shift.end, time[-1] - LEVEL)
    before, later = _mean(torque[~shifts], torque[0]), _mean(torque[rests], torque[-1])
    # with the sign of the torque before
    sign = 1.0 if before >= 0.0 else -1.0
    least = float(np.min(sign * torque[shifts], initial=np.inf))
    hole = max(0.0, min(sign * before, sign * later) - least)
    known = shift.before != NEUTRAL and before != 0.0
    return hole, hole / abs(before) if known else float("nan")


def _mean(values: Array, instead: float) -> float:
    return float(np.mean(values)) if len(values) else float(instead)


def _overshoot(part: Window, shift: Shift, box: Gearbox, prefix: str, inside: NDArray[np.bool_]) -> tuple[float, float]:
    """How far the input leaves the range between the speeds of both gears, up and down."""
    speed, output = part[f"{prefix}.{box.input}.speed"], part[f"{prefix}.{box.output}.speed"]
    ratios = box.ratios
    first, second = ratios.get(shift.before), ratios.get(shift.after)
    start = speed[inside][0] if np.any(inside) else speed[0]
    both = np.array([np.full_like(speed, start) if first is None else first * output, (second or 0.0) * output])
    above = speed - np.max(both, axis=0)
    below = np.min(both, axis=0) - speed
    flare, sag = (float(np.max(values[inside], initial=0.0)) for values in (above, below))
    # round-off of the solver is no flare
    least = 1e-5 * float(np.max(np.abs(speed), initial=1.0))
    return (flare if flare > least else 0.0), (sag if sag > least else 0.0)


def _tie_up(run: Recorded, part: Window, shift: Shift, prefix: str) -> float:
    """Torque of elements that open against the direction that they had before, from begin to end of the shift."""
    names = [f"{prefix}.{name}" for name in shift.opens]
    found = (opposing(run, shift, name, part.time, part[f"{name}.torque"]).torque for name in names)
    return max((float(np.max(torque, initial=0.0)) for torque in found), default=0.0)


def _temperatures(part: Window, prefix: str, names: list[str]) -> dict[str, float]:
    """The highest temperature of the thermal node of each element that has one."""
    found = {}
    for branch in part.run.wiring.contacts:
        element = branch.name.removeprefix(f"{prefix}.")
        path = branch.component.heat_path()
        if element in names and branch.name != element and path is not None:
            found[element] = float(np.max(part[f"{path.node.name}.temperature"]))
    return found
