"""Measures of a hundred shifts of four boxes against formulas written again from their page, from dense rows."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest
from scipy.signal import lsim

import clutchwork as cw
from support.shift_car import SENSED, car

BOXES = ("zf-8hp70", "ford-10r80", "six-speed", "mb-9g-v1")
EACH = 26
STEP = 1e-3  # s


def pairs(box: cw.Gearbox) -> list[tuple[str, str]]:
    """Some pairs of gears whose step of speed an engine can follow, always the same ones."""
    forward = [gear for gear, ratio in box.ratios.items() if ratio > 0.0]
    near = [(a, b) for a, b in permutations(forward, 2) if 0.4 < box.ratios[b] / box.ratios[a] < 2.5]
    return [near[number] for number in np.random.default_rng(61).permutation(len(near))[: EACH // 2]]


def dose(acceleration: np.ndarray) -> float:
    """Wd of ISO 2631-1 as three filters in a row in the time domain, at rest at the first value."""
    values = acceleration - acceleration[0]
    time = np.arange(len(values)) * STEP
    low, high, turn, q = 2.0 * np.pi * 0.4, 2.0 * np.pi * 100.0, 2.0 * np.pi * 2.0, 0.63
    for over, under in (
        ((1.0, 0.0, 0.0), (1.0, 2.0**0.5 * low, low**2)),
        ((high**2,), (1.0, 2.0**0.5 * high, high**2)),
        ((1.0 / turn, 1.0), (1.0 / turn**2, 1.0 / (q * turn), 1.0)),
    ):
        _, values, _ = lsim((over, under), values, time)
    return float((np.sum(values**4) * STEP) ** 0.25)


def felt(speed: np.ndarray, window: int = 50) -> np.ndarray:
    """Mean acceleration of the window behind less that of the one before, over the window; even beyond the ends."""
    first, last = speed[1] - speed[0], speed[-1] - speed[-2]
    whole = np.concatenate(
        [speed[0] + first * np.arange(-window, 0), speed, speed[-1] + last * np.arange(1, window + 1)]
    )
    behind = (whole[2 * window :] - whole[window:-window]) / (window * STEP)
    before = (whole[window:-window] - whole[: -2 * window]) / (window * STEP)
    return (behind - before) / (window * STEP)


@pytest.mark.parametrize("name", BOXES)
def test_measures_are_those_of_their_page(name: str) -> None:
    box = cw.Gearbox.load(name)
    found = cw.shifts.survey(
        lambda gear: car(box, gear, 180.0),
        box,
        pairs(box),
        sensed=SENSED,
        torque="half_shafts.torque",
        acceleration="car.acceleration",
        until=2.6,
        rtol=1e-7,
    )
    assert len(found) == EACH
    for one in found.results:
        measured, run = one.quality, one.run
        assert measured is not None
        assert one.record.reached
        shift = measured.shift
        begin, end = shift.begin, shift.end
        time = np.arange(begin - 0.4, min(end + 0.5, float(run.time[-1])), STEP)
        part = run.at(time)
        # (9): levels of 0.2 s before and behind, the least between
        torque = part["half_shafts.torque"]
        before, behind = np.mean(torque[time < begin - 0.2]), np.mean(torque[time > max(end, time[-1] - 0.2)])
        sign = np.sign(before)
        hole = max(0.0, min(sign * before, sign * behind) - np.min(sign * torque[time >= begin - 0.2]))
        # a sample beside another one: 2 N m of torques that change by 2000 N m in a second
        assert measured.torque_hole == pytest.approx(hole, abs=2.0), shift
        assert measured.peak_jerk == pytest.approx(np.max(np.abs(felt(part["car.speed"]))), rel=5e-3, abs=0.02)
        # held inputs of the filters between samples
        assert measured.vibration_dose == pytest.approx(dose(part["car.acceleration"]), rel=0.01)
        inside = run.at(np.arange(begin, end, STEP))
        speed, output = inside[f"gearbox.{box.input}.speed"], inside[f"gearbox.{box.output}.speed"]
        bounds = np.array([box.ratios[shift.before] * output, box.ratios[shift.after] * output])
        assert measured.flare == pytest.approx(max(0.0, float(np.max(speed - bounds.max(axis=0)))), abs=0.5)
        assert measured.sag == pytest.approx(max(0.0, float(np.max(bounds.min(axis=0) - speed))), abs=0.5)
        ends = run.at(np.array([begin, end]))
        for element, energy in measured.slip_energy.items():
            slips, torques = inside[f"gearbox.{element}.slip"], inside[f"gearbox.{element}.torque"]
            work = float(np.sum(np.abs(slips * torques))) * STEP
            # sums over steps, beside kinks of a torque
            assert energy == pytest.approx(work, rel=0.03, abs=15.0)
            assert energy == pytest.approx(float(np.diff(ends[f"gearbox.{element}.heat"])[0]), abs=1.0)
        against = 0.0
        for element in shift.opens:
            usual = np.sign(np.mean(part[f"gearbox.{element}.torque"][time < begin]))
            against = max(against, float(np.max(-usual * inside[f"gearbox.{element}.torque"])))
        assert measured.tie_up == pytest.approx(max(0.0, against), abs=5.0)
