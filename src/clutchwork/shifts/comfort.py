"""How a shift feels: jerk and vibration dose of the vehicle. docs/theory/jerk.md, docs/theory/shifts.md (10)."""

from __future__ import annotations

import numpy as np

from clutchwork.base import UseError
from clutchwork.base.arrays import Array
from clutchwork.results.felt import WINDOW, felt_jerk

# weighting for horizontal vibration of seated people, Wd of ISO 2631-1: limits, transition [Hz] and its quality
LOW, HIGH, TRANSITION, QUALITY = 0.4, 100.0, 2.0, 0.63
# how long the weighting remembers [s], to 1e-15 of what was
MEMORY = 20.0


def jerk(speed: Array, step: float, *, window: float = WINDOW) -> Array:
    """The perceived jerk [m/s3]: change of the mean acceleration over a window, docs/theory/jerk.md (1).

    Parameters: speed [m/s] at equal steps [s]; window [s]. Before the first speed and behind the last one it is taken
    to go on evenly. UseError where the record is shorter than the window.
    """
    if not 0.0 < window <= step * len(speed):
        record = f"{step * len(speed):g} s"
        raise UseError(
            "jerk", [f"window = {window:g} s does not fit into a record of {record}; give 0.05 s, and a speed in m/s"]
        )
    count = max(1, round(window / step))
    ahead = speed[0] + (speed[1] - speed[0]) * np.arange(-count, 0)
    behind = speed[-1] + (speed[-1] - speed[-2]) * np.arange(1, count + 1)
    return felt_jerk(np.concatenate([ahead, speed, behind]), count * step, count)


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


def vibration_dose(acceleration: Array, step: float) -> float:
    """Vibration dose value [m/s1.75]: fourth root of the integral of the weighted acceleration to the fourth."""
    return float((np.sum(weighted(acceleration, step) ** 4) * step) ** 0.25)
