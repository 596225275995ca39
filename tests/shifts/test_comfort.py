"""Jerk, weighting and vibration dose against closed forms and the table of ISO 2631-1."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.shifts.comfort import HIGH, LOW, QUALITY, TRANSITION, jerk, low_pass, vibration_dose, weighted

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


@pytest.mark.parametrize("rest", [0.0, 0.5, 20.0])
def test_what_happens_at_the_end_does_not_come_round_to_the_begin(rest: float) -> None:
    """A jump of 0.2 m/s2 after 0.1 s: the same dose however long the acceleration was level before."""
    values = np.concatenate([np.ones(round(rest / STEP)), np.where(np.arange(1300) < 100, 1.0, 1.2)])
    # the step response of (10), integrated with steps of 1e-5 s
    assert vibration_dose(values, STEP) == pytest.approx(0.2 * step_dose(1.2), rel=2e-3)


def step_dose(duration: float, h: float = 1e-5) -> float:
    """Dose of a jump of 1 m/s2 over some time, from the poles of (10)."""
    low, high, turn = (2.0 * np.pi * f for f in (LOW, HIGH, TRANSITION))
    over = np.polymul([1.0, np.sqrt(2.0) * low, low**2], [1.0 / high**2, np.sqrt(2.0) / high, 1.0])
    over = np.polymul(over, [1.0 / turn**2, 1.0 / (QUALITY * turn), 1.0])
    poles = np.roots(over)
    # of s (1 + s/turn) / over, by residues
    shares = poles * (1.0 + poles / turn) / np.polyval(np.polyder(over), poles)
    time = (np.arange(round(duration / h)) + 0.5) * h
    response = (np.exp(np.outer(time, poles)) @ shares).real
    return float((np.sum(response**4) * h) ** 0.25)


def test_jerk_of_a_steady_one_and_of_a_sine() -> None:
    time = np.arange(0.0, 2.0, STEP)
    middle = slice(500, 1500)
    assert jerk(1.5 * time**2, STEP)[middle] == pytest.approx(3.0, rel=1e-9)
    # the mean over two windows takes (sin x/x)^2 of a wave, x = 0.05 s times half its rate
    wave = 2.0 * np.pi * 2.0
    share = np.sinc(0.05 * wave / 2.0 / np.pi) ** 2
    assert np.max(jerk(np.sin(wave * time), STEP)[middle]) == pytest.approx(share * wave**2, rel=1e-4)


def test_a_jump_has_the_jerk_of_its_height_over_the_window() -> None:
    time = np.arange(0.0, 4.0, STEP)
    for window in (0.05, 0.2):
        found = jerk(np.maximum(time - 2.0, 0.0), STEP, window=window)
        assert np.max(found) == pytest.approx(1.0 / window, rel=1e-9)
        # of as much area as the jump has, and over two windows
        assert np.sum(found) * STEP == pytest.approx(1.0, rel=1e-9)
        assert np.all(found[np.abs(time - 2.0) > window + STEP] < 1e-9)


def test_ends_go_on_evenly() -> None:
    time = np.arange(0.0, 1.0, STEP)
    assert np.max(np.abs(jerk(2.0 + 3.0 * time, STEP))) < 1e-9


def test_the_filter_has_no_delay() -> None:
    wave = np.exp(-(((np.arange(3000) - 1500) / 60.0) ** 2))
    assert abs(int(np.argmax(low_pass(wave, STEP, 10.0))) - 1500) <= 1


def test_a_window_that_is_no_whole_number_of_steps_is_that_which_was_asked_for() -> None:
    step, window = 0.03, 0.1
    time = np.arange(0.0, 6.0, step)
    speed = np.maximum(time - 3.0, 0.0)
    found = jerk(speed, step, window=window)
    assert np.max(found) == pytest.approx(1.0 / window, rel=1e-9)
    # of the speed that is straight between two steps
    at = time[:, None] + window * np.array([1.0, 0.0, -1.0])
    inside = (at.min(axis=1) >= 0.0) & (at.max(axis=1) <= time[-1])
    whole = np.interp(at, time, speed) @ np.array([1.0, -2.0, 1.0]) / window**2
    assert found[inside] == pytest.approx(whole[inside], abs=1e-9)
    # a window of whole steps is not touched by their round-off
    assert np.max(jerk(np.maximum(time - 3.0, 0.0), "30 ms", window="90 ms")) == pytest.approx(1.0 / 0.09, rel=1e-9)


STEADY = np.arange(100.0)
REFUSED = {
    "no step": (lambda: jerk(STEADY, 0.0), "step is 0.0: must be a time > 0 s"),
    "back": (lambda: vibration_dose(STEADY, -1e-3), "step is -0.001: must be a time > 0 s"),
    "unit": (lambda: jerk(STEADY, "1 m"), "step is '1 m': must be a time > 0 s"),
    "no window": (lambda: jerk(STEADY, 1e-3, window=0.0), "window is 0.0: must be a time > 0 s"),
    "short": (
        lambda: jerk(STEADY, 0.03),
        "window = 0.05 s: must be at least two steps, 0.06 s, and at most",
    ),
    "long": (lambda: jerk(STEADY, 1e-3, window=1.0), "at most the record, 0.1 s; sample more densely, or give another"),
    "nothing": (lambda: jerk([], 1e-3), "speed is []: must be two numbers or more at equal steps"),
    "one": (lambda: vibration_dose([1.0], 1e-3), "acceleration is [1.0]: must be two numbers or more"),
    "table": (lambda: jerk(np.zeros((3, 3)), 1e-3), "must be two numbers or more at equal steps"),
    "words": (lambda: vibration_dose(["locked", "forward"], 1e-3), "must be two numbers or more at equal steps"),
    "nan": (lambda: vibration_dose([0.0, 1.0, float("nan")], 1e-3), "acceleration[2] is nan: must be finite"),
    "inf": (lambda: jerk([*STEADY, float("inf")], 1e-3), "speed[100] is inf: must be finite"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_record_is_refused(name: str) -> None:
    call, said = REFUSED[name]
    with pytest.raises(cw.UseError) as caught:
        call()
    assert said in str(caught.value)


def test_lists_and_steps_with_units_are_read() -> None:
    values = np.sin(0.1 * STEADY)
    assert np.array_equal(jerk(values.tolist(), "10 ms"), jerk(values, 0.01))
    assert vibration_dose(values.tolist(), "10 ms") == vibration_dose(values, 0.01)
