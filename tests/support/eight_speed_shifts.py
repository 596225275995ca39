"""Shifts of the 8HP70 in a car, one at a time, for tests of what acts on its elements."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

import clutchwork as cw
from support.shift_car import SENSED

BOX = cw.Gearbox.load("zf-8hp70")


def speed(before: str, after: str) -> float:
    """Of the input [rad/s], so that the engine can follow: at most 450 behind a downshift, at least 75 else."""
    step = BOX.ratios[after] / BOX.ratios[before]
    return min(200.0, 450.0 / step) if step > 1.0 else max(200.0, 75.0 / step)


def shift(
    model: cw.System, before: str, after: str, pedal: float, **more: object
) -> tuple[cw.Trajectory, cw.shifts.ShiftController]:
    plant = more.pop("plant", None) or cw.shifts.plant_of(model, BOX)
    control = cw.shifts.ShiftController(BOX, plant, gear=before, **more)  # type: ignore[arg-type]
    sim = cw.Simulator(model, rtol=1e-6)
    cw.shifts.drive(sim, control, 0.5, sensed=SENSED, throttle=lambda _: pedal)
    control.request(after)
    return cw.shifts.drive(sim, control, 2.6, sensed=SENSED, throttle=lambda _: pedal), control


def qualities(run: cw.Trajectory) -> list[cw.shifts.ShiftQuality]:
    return cw.shifts.qualities(run, BOX, torque="half_shafts.torque", acceleration="car.acceleration")


def felt(made: Callable[[str, float], cw.Driveline], pairs: Iterable[tuple[str, str]]) -> tuple[int, float, float]:
    """Shifts, mean of their largest jerk [m/s3], and of their torque hole [N m]; each of them reaches its gear.

    Parameters: made, the car in a gear with a speed of the input [rad/s].
    """
    found = list[cw.shifts.ShiftQuality]()
    for pair in pairs:
        begin = speed(*pair)
        one = cw.shifts.survey(
            lambda gear, at=begin: made(gear, at),
            BOX,
            [pair],
            sensed=SENSED,
            torque="half_shafts.torque",
            acceleration="car.acceleration",
            rtol=1e-6,
        )
        assert not one.missed, str(one)
        found += [result.quality for result in one.results if result.quality]
    jerk = float(np.mean([quality.peak_jerk for quality in found]))
    return len(found), jerk, float(np.mean([quality.torque_hole for quality in found]))
