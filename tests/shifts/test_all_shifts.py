"""Every shift of known gearboxes under the controller: the gear is reached, nothing is lost, nothing is silent."""

from __future__ import annotations

from math import isfinite

import numpy as np
import pytest

import clutchwork as cw
from support.shift_car import survey

WHOLE = ("six-speed", "zf-8hp70", "ford-10r80")
# hubs and power splits have no reverse gear and no shift controller, dual clutches one of their own
LEFT_OUT = (
    *("nexus7", "sa-af", "sa-aw", "sa-sprinter7", "toyota-p410", "toyota-p112", "gm-2ml70"),
    *("vw-dq200", "vw-dq250"),
)
BOXES = cw.catalogue()
AUTOMATICS = [
    name
    for name, box in BOXES.items()
    if name not in LEFT_OUT and any(ratio < 0.0 for gear, ratio in box.ratios.items() if gear[0] == "R")
]
LONGEST = 1.5  # s


def check(box: cw.Gearbox, one: cw.shifts.Surveyed) -> None:
    """A shift that reached its gear as its record says, in a run that loses no energy."""
    record, quality, run = one.record, one.quality, one.run
    assert record.reached, record
    assert record.end is not None
    assert record.end - record.begin < LONGEST
    assert quality is not None
    assert quality.shift.before == record.before
    assert record.begin <= quality.shift.begin <= quality.shift.end <= record.end + 0.1
    # elements locked, ratio held
    closed = box.closed_in(record.after)
    friction = [name for name in closed if box.element(name).kind in ("clutch", "brake")]
    assert all(run[f"gearbox.{name}.state"][-1] == "locked" for name in friction)
    assert all(run[f"gearbox.{name}.sleeve"][-1] > 0.99 for name in closed if name not in friction)
    turning = run[f"gearbox.{box.input}.speed"][-1], box.ratios[record.after] * run[f"gearbox.{box.output}.speed"][-1]
    # in mesh a dog clutch has play, across which it swings
    assert turning[0] == pytest.approx(turning[1], rel=1e-9 if friction == list(closed) else 1e-2)
    assert np.all(np.isfinite(run.rows))
    assert abs(run.energy.residual) < 1e-6 * run.energy.turnover
    numbers = [
        quality.peak_jerk,
        quality.rms_jerk,
        quality.vibration_dose,
        quality.torque_hole,
        *quality.slip_energy.values(),
    ]
    assert all(isfinite(value) for value in numbers)


def smooth(one: cw.shifts.Surveyed) -> None:
    """What a single exchange of this calibration may do at most."""
    quality, record = one.quality, one.record
    assert quality is not None
    if "double" in record.kind:
        return
    wanted = cw.shifts.ShiftSettings()
    # longer where the torque at hand is little, up to `stretch` times
    assert -0.12 < quality.shift.inertia_time - wanted.inertia_time < (wanted.stretch - 1.0) * wanted.inertia_time + 0.1
    assert quality.sag < 5.0
    assert quality.tie_up < 10.0
    # where the torque is handed over before speeds change nothing runs up
    handed_over = any(state == "torque" for _, state in record.phases)
    assert quality.flare < (1.0 if handed_over else 5.0)
    assert quality.peak_jerk < 60.0


def test_who_is_left_out() -> None:
    assert sorted({*BOXES} - {*AUTOMATICS}) == sorted(LEFT_OUT)


@pytest.mark.parametrize("name", WHOLE)
def test_each_gear_to_the_next_and_back(name: str) -> None:
    """With power and without."""
    box = BOXES[name]
    found = survey(box)
    forward = sum(ratio > 0.0 for ratio in box.ratios.values())
    assert len(found) == 4 * (forward - 1)
    for one in found.results:
        check(box, one)
        smooth(one)
    assert {record.power_on for record, _ in found} == {True, False}


@pytest.mark.parametrize("name", [name for name in AUTOMATICS if name not in WHOLE])
def test_one_shift_up_and_one_down(name: str) -> None:
    """A different pair of gears in each box, so that all numbers of gears have their turn."""
    box = BOXES[name]
    pairs = cw.shifts.neighbours(box)
    place = 2 * (len(name) % (len(pairs) // 2))
    for one in survey(box, pairs[place : place + 2], throttles=(0.3,), until=2.5).results:
        check(box, one)


def test_dog_clutches_open_without_torque_and_close_near_equal_speeds() -> None:
    """The 9HP48 has two of them; the engine comes to their speed where it drags."""
    box = BOXES["zf-9hp48"]
    for one in survey(box, [("4", "5"), ("5", "4"), ("7", "8"), ("8", "7")]).results:
        check(box, one)
        (first, *_) = one.record.exchanges
        run, name = one.run, f"gearbox.{'A' if 'A' in (first.off, first.on) else 'F'}"
        moves = np.flatnonzero(np.abs(np.diff(run[f"{name}.command"])) > 0.5)
        at = int(moves[-1])
        if first.on in ("A", "F"):
            assert abs(run[f"{name}.rate"][at]) < 5.0
        elif one.record.power_on:
            assert abs(run[f"{name}.torque"][at]) < 0.1 * np.max(np.abs(run[f"{name}.torque"]))
