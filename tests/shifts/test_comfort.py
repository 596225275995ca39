"""Jerk, weighting and vibration dose against closed forms and the table of ISO 2631-1."""

from __future__ import annotations

import numpy as np
import pytest

from clutchwork.shifts.comfort import jerk, low_pass, vibration_dose, weighted

STEP = 1e-3  # s

# factors of Wd in ISO 2631-1, table 3, at third-octave frequencies [Hz], in thousandths
WD = {0.5: 853, 1.0: 1011, 2.0: 890, 4.0: 512, 8.0: 253, 16.0: 125, 31.5: 63.2}


@pytest.mark.parametrize("frequency", WD)
def test_weighting_meets_the_table(frequency: float) -> None:
    time = np.arange(0.0, 40.0 / frequency + 30.0, STEP)
    found = weighted(np.sin(2.0 * np.pi * frequency * time), STEP)
    middle = slice(len(time) // 3, 2 * len(time) // 3)
    # the table is rounded to three digits, and 31.5 Hz is 10^1.5
    assert np.sqrt(2.0 * np.mean(found[middle] ** 2)) == pytest.approx(1e-3 * WD[frequency], rel=8e-3)


def test_a_constant_acceleration_gives_no_dose() -> None:
    assert vibration_dose(np.full(2000, 3.0), STEP) < 1e-12


def test_dose_grows_with_the_amplitude_and_with_the_fourth_root_of_time() -> None:
    wave = np.sin(2.0 * np.pi * 4.0 * np.arange(0.0, 20.0, STEP))
    once = vibration_dose(wave, STEP)
    assert vibration_dose(2.0 * wave, STEP) == pytest.approx(2.0 * once)
    # the ends, where a wave begins, count a little
    assert vibration_dose(np.concatenate([wave, wave]), STEP) == pytest.approx(2.0**0.25 * once, rel=5e-3)
    # amplitude 0.512 over 20 s: the mean of the fourth power of a sine is 3/8
    assert once == pytest.approx(0.512 * (0.375 * 20.0) ** 0.25, rel=1e-2)


def test_jerk_of_a_ramp_and_of_a_sine() -> None:
    time = np.arange(0.0, 2.0, STEP)
    middle = slice(500, 1500)
    assert jerk(3.0 * time, STEP, 20.0)[middle] == pytest.approx(3.0, rel=1e-3)
    # at a tenth of the cut-off the filter takes 1e-4 of a wave
    wave = 2.0 * np.pi * 2.0
    assert np.max(jerk(np.sin(wave * time), STEP, 20.0)[middle]) == pytest.approx(wave, rel=1e-3)


def test_a_step_has_the_jerk_of_the_cut_off() -> None:
    """A jump of 1 m/s2 behind a filter of second order forward and backward: peak pi f0/sqrt(2)."""
    values = np.where(np.arange(4000) < 2000, 0.0, 1.0)
    for cut_off in (5.0, 20.0):
        # a jump takes a step of the grid; the integral of 1/(1 + x^4) from 0 to infinity is pi/(2 sqrt 2)
        peak = 2.0 * cut_off * np.pi / (2.0 * np.sqrt(2.0))
        assert np.max(jerk(values, STEP, cut_off)) == pytest.approx(peak, rel=5e-3)


def test_the_filter_has_no_delay() -> None:
    wave = np.exp(-(((np.arange(3000) - 1500) / 60.0) ** 2))
    assert abs(int(np.argmax(low_pass(wave, STEP, 10.0))) - 1500) <= 1
