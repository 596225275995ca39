"""How a shift feels: jerk and vibration dose value of the vehicle. docs/theory/shifts.md (9) to (11)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# weighting for horizontal vibration of seated people, Wd of ISO 2631-1: limits, transition [Hz] and its quality
LOW, HIGH, TRANSITION, QUALITY = 0.4, 100.0, 2.0, 0.63


def jerk(acceleration: Array, step: float, cut_off: float) -> Array:
    """Rate of change of an acceleration [m/s3], low-passed without delay.

    Parameters: acceleration [m/s2] at equal steps [s]; cut_off [Hz] at which the filter halves the power. An event
    makes the acceleration jump, so that jerk has no value without a cut-off.
    """
    return np.gradient(low_pass(acceleration, step, cut_off), step)


def low_pass(values: Array, step: float, cut_off: float) -> Array:
    """Butterworth filter of second order, forward and backward: no delay, the ends continued as they are."""
    frequency = np.fft.rfftfreq(3 * len(values), step)
    padded = np.concatenate([np.full(len(values), values[0]), values, np.full(len(values), values[-1])])
    gain = 1.0 / (1.0 + (frequency / cut_off) ** 4)
    filtered = np.fft.irfft(np.fft.rfft(padded) * gain, len(padded))
    return np.asarray(filtered[len(values) : 2 * len(values)])


def weighted(acceleration: Array, step: float) -> Array:
    """Acceleration with the weighting Wd of ISO 2631-1 for fore-and-aft vibration [m/s2]: equation (10)."""
    count = len(acceleration)
    padded = np.concatenate([np.full(count, acceleration[0]), acceleration, np.full(count, acceleration[-1])])
    s = 2j * np.pi * np.fft.rfftfreq(len(padded), step)
    low, high, turn = (2.0 * np.pi * f for f in (LOW, HIGH, TRANSITION))
    with np.errstate(divide="ignore", invalid="ignore"):
        gain = s * s / (s * s + np.sqrt(2.0) * low * s + low * low)
        gain = gain / (1.0 + np.sqrt(2.0) * s / high + (s / high) ** 2)
        gain = gain * (1.0 + s / turn) / (1.0 + s / (QUALITY * turn) + (s / turn) ** 2)
    spectrum = np.fft.rfft(padded - padded[0]) * gain
    return np.asarray(np.fft.irfft(spectrum, len(padded))[count : 2 * count])


def vibration_dose(acceleration: Array, step: float) -> float:
    """Vibration dose value [m/s1.75]: fourth root of the integral of the weighted acceleration to the fourth."""
    return float((np.sum(weighted(acceleration, step) ** 4) * step) ** 0.25)
