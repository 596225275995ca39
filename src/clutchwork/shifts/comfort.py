"""How a shift feels: jerk and vibration dose of the vehicle. docs/theory/jerk.md, docs/theory/shifts.md (10)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from clutchwork.base import UseError, quote
from clutchwork.base.arrays import Array
from clutchwork.declare.calls import explained
from clutchwork.results.felt import WINDOW, felt_jerk
from clutchwork.sweeps.numbers import number

# weighting for horizontal vibration of seated people, Wd of ISO 2631-1: limits, transition [Hz] and its quality
LOW, HIGH, TRANSITION, QUALITY = 0.4, 100.0, 2.0, 0.63
# how long the weighting remembers [s], to 1e-15 of what was
MEMORY = 20.0
# of a window in steps
ROUND_OFF = 1e-9


@explained("cw.shifts.jerk", speed="run['car.speed']", step="1e-3")
def jerk(speed: Sequence[float] | Array, step: Any, *, window: Any = WINDOW) -> Array:
    """The perceived jerk [m/s3]: change of the mean acceleration over a window, docs/theory/jerk.md (1).

    Parameters: speed [m/s] at equal steps [s], or with a unit; window [s], at least two steps. Within a step
    the speed is taken as straight; before the first one and behind the last one it is taken to go on evenly. UseError
    for a record that is shorter than the window, or has numbers that are not finite.
    """
    call = "cw.shifts.jerk"
    length, over = seconds(call, "step", step, "1e-3"), seconds(call, "window", window, "0.05")
    speeds = record(call, "speed", speed, "run['car.speed']")
    whole, least = length * len(speeds), 2.0 * length
    # round-off of both
    if not least * (1.0 - ROUND_OFF) <= over <= whole * (1.0 + ROUND_OFF):
        bounds = f"at least two steps, {least:g} s, and at most the record, {whole:g} s"
        raise UseError(call, [f"window = {over:g} s: must be {bounds}; sample more densely, or give another window"])
    steps = over / length
    count = int(np.ceil(steps - ROUND_OFF * steps))
    ahead = speeds[0] + (speeds[1] - speeds[0]) * np.arange(-count, 0)
    behind = speeds[-1] + (speeds[-1] - speeds[-2]) * np.arange(1, count + 1)
    padded = np.concatenate([ahead, speeds, behind])
    if abs(steps - round(steps)) <= ROUND_OFF * steps:
        return felt_jerk(padded, count * length, count)
    places, own = np.arange(-count, len(speeds) + count), np.arange(len(speeds))
    later, earlier = (np.interp(own + side * steps, places, padded) for side in (1.0, -1.0))
    found: Array = (later - 2.0 * speeds + earlier) / over**2
    return found


def low_pass(values: Array, step: float, cut_off: float) -> Array:
    """Butterworth filter of second order, forward and backward: no delay, the ends continued as they are.

    Parameters: values at equal steps [s]; cut_off [Hz], at which the filter halves the power.
    """
    frequency = np.fft.rfftfreq(3 * len(values), step)
    padded = np.concatenate([np.full(len(values), values[0]), values, np.full(len(values), values[-1])])
    gain = 1.0 / (1.0 + (frequency / cut_off) ** 4)
    filtered = np.fft.irfft(np.fft.rfft(padded) * gain, len(padded))
    return np.asarray(filtered[len(values) : 2 * len(values)])


def weighted(acceleration: Array, step: float) -> Array:
    """Acceleration with the weighting Wd of ISO 2631-1 for fore-and-aft vibration [m/s2]: equation (10).

    Before the first value it was as it is there.
    """
    count, rest = len(acceleration), int(MEMORY / step)
    # what comes behind the end goes round to the begin: it is held for a while, and then forgotten
    changes = acceleration - acceleration[0]
    padded = np.concatenate([changes, np.full(rest, changes[-1]), np.zeros(rest)])
    s = 2j * np.pi * np.fft.rfftfreq(len(padded), step)
    low, high, turn = (2.0 * np.pi * f for f in (LOW, HIGH, TRANSITION))
    gain = s * s / (s * s + np.sqrt(2.0) * low * s + low * low)
    gain = gain / (1.0 + np.sqrt(2.0) * s / high + (s / high) ** 2)
    gain = gain * (1.0 + s / turn) / (1.0 + s / (QUALITY * turn) + (s / turn) ** 2)
    return np.asarray(np.fft.irfft(np.fft.rfft(padded) * gain, len(padded))[:count])


@explained("cw.shifts.vibration_dose", acceleration="run['car.acceleration']", step="1e-3")
def vibration_dose(acceleration: Sequence[float] | Array, step: Any) -> float:
    """Vibration dose value [m/s1.75]: fourth root of the integral of the weighted acceleration to the fourth.

    Parameters: acceleration [m/s2] at equal steps [s], or with a unit. UseError for numbers that are not
    finite.
    """
    call = "cw.shifts.vibration_dose"
    length = seconds(call, "step", step, "1e-3")
    values = record(call, "acceleration", acceleration, "run['car.acceleration']")
    return float((np.sum(weighted(values, length) ** 4) * length) ** 0.25)


def seconds(call: str, name: str, value: Any, such: str) -> float:
    """A time above zero [s], from a number or a string with a unit; UseError for anything else."""
    found = number(value, "s")
    if found is None or not 0.0 < found < np.inf:
        raise UseError(call, [f"{name} is {quote(value)}: must be a time > 0 s; give one such as {such}"])
    return found


def record(call: str, name: str, values: Any, such: str) -> Array:
    """Values at equal steps, two or more finite ones; UseError for anything else."""
    try:
        found = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        found = np.zeros(0)
    if found.ndim != 1 or len(found) < 2:
        raise UseError(call, [f"{name} is {quote(values)}: must be two numbers or more at equal steps, such as {such}"])
    wrong = np.flatnonzero(~np.isfinite(found))
    if len(wrong):
        fault = f"{name}[{wrong[0]}] is {found[wrong[0]]:g}: must be finite"
        raise UseError(call, [f"{fault}; leave what is not known out, or fill it in"])
    return found
