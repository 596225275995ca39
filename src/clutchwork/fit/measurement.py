"""Measured slip, torque and load, checked before anything is fitted to them."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.fit.failure import FitError, all_of, numbers_of, rising

FEWEST = 5
# of what may be one number for all samples
UNITS = {"load": "N m", "temperature": "K"}


@dataclass(frozen=True, eq=False)
class Measurement:
    """Samples in order of time; the torque has the sign of the slip while it slides."""

    time: Array  # s, from 0
    slip: Array  # rad/s or m/s
    torque: Array  # N m or N
    load: Array  # N m or N, torque per unit of coefficient
    translation: bool  # m/s and N in place of rad/s and N m
    turned: bool  # whether the torque was given as it acts on the follower, against the slip
    temperature: Array | None = None  # K

    @property
    def size(self) -> float:
        """Root mean square of the torque [N m]."""
        return float(np.sqrt(np.mean(self.torque**2)))


def measurement(
    time: Any, slip: Any, torque: Any, load: Any, *, temperature: Any = None, translation: bool = False
) -> Measurement:
    """Check samples and bring them into one form; FitError says what is wrong and where.

    Parameters: time [s], rising; slip [rad/s or m/s]; torque [N m or N], positive with the slip or against it; load
    [N m or N] and temperature [K], one number or one for each sample.
    """
    given = {"time": time, "slip": slip, "torque": torque, "load": load}
    given |= {} if temperature is None else {"temperature": temperature}
    found = all_of(*(partial(_row, name, value, UNITS.get(name, "")) for name, value in given.items()))
    count = len(found[0])
    rows = {name: np.full(count, row) if np.ndim(row) == 0 else row for name, row in zip(given, found, strict=True)}
    all_of(*(partial(_complete, name, row, count) for name, row in rows.items()))
    _sensible(rows)
    # friction dissipates: the sign of the work tells on whom the torque was measured
    turned = float(rows["torque"] @ rows["slip"]) < 0.0
    torque = -rows["torque"] if turned else rows["torque"]
    time, slip, load = rows["time"] - rows["time"][0], rows["slip"], rows["load"]
    return Measurement(time, slip, torque, load, translation, turned, rows.get("temperature"))


def _row(name: str, value: Any, unit: str) -> Any:
    """A row, or the number of one that may be given as such: that has a unit."""
    return numbers_of(name, value) if np.ndim(value) > 0 or not unit else _number(name, value, unit)


def _complete(name: str, row: Array, count: int) -> None:
    if len(row) != count:
        raise FitError(name, f"has {len(row)} values, time has {count}", "give one value for each instant")
    _finite(name, row)


def _number(name: str, value: Any, unit: str) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise FitError(name, f"is {value!r}", f"give a number in [{unit}], or one for each instant") from None


def _finite(name: str, row: Array) -> None:
    bad = np.flatnonzero(~np.isfinite(row))
    if len(bad):
        raise FitError(name, f"is {row[bad[0]]} at sample {bad[0]}", "remove samples that were not measured")


def _sensible(rows: dict[str, Array]) -> None:
    """Refuse what cannot be a measurement of friction."""
    _enough(rows)
    all_of(*(partial(check, rows) for check in (_warm, _timed, _pressed, _slides, _rubs)))


def _enough(rows: dict[str, Array]) -> None:
    if len(rows["time"]) < FEWEST:
        raise FitError("time", f"has {len(rows['time'])} values", f"give at least {FEWEST} samples")


def _warm(rows: dict[str, Array]) -> None:
    if "temperature" in rows and np.any(rows["temperature"] <= 0.0):
        at = int(np.argmin(rows["temperature"]))
        raise FitError("temperature", f"is {rows['temperature'][at]:g} at sample {at}", "give it in kelvin")


def _timed(rows: dict[str, Array]) -> None:
    time = rows["time"]
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if len(back):
        at = back[0] + 1
        other = rising({name: rows[name] for name in ("slip", "torque")})
        raise FitError("time", f"does not rise at sample {at} ({time[at]:g} s)", f"sort the samples by time{other}")


def _pressed(rows: dict[str, Array]) -> None:
    load = rows["load"]
    if np.any(load < 0.0):
        at = int(np.argmin(load))
        raise FitError("load", f"is {load[at]:g} N m at sample {at}", "give the load as a magnitude, >= 0")
    if not np.any(load):
        raise FitError("load", "is always zero", "give the load that presses the contact together")


def _slides(rows: dict[str, Array]) -> None:
    if not np.any(rows["slip"]):
        remedy = "at rest friction is only bounded, not known: record samples that slide"
        raise FitError("slip", "is always zero", remedy)


def _rubs(rows: dict[str, Array]) -> None:
    if not np.any(rows["torque"]):
        raise FitError("torque", "is always zero", "check the column and the sensor")
