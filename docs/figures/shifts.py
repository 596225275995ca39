"""Shifts of three gearboxes and the eight-speed car."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

sys.path[:0] = [str(Path(__file__).resolve().parents[2] / "examples" / "eight_speed")]

import eight_speed  # noqa: E402
import eight_speed_model as model  # noqa: E402

import clutchwork as cw  # noqa: E402

BOXES = ("six-speed", "zf-8hp70", "ford-10r80")
TURBINE = 200.0  # rad/s


def survey(name: str) -> cw.shifts.Survey:
    """All shifts of a box in the car of the example."""
    box = cw.Gearbox.load(name)

    def in_gear(gear: str) -> cw.Driveline:
        return model.car(
            box,
            gear,
            TURBINE / box.ratios[gear] / model.FINAL_DRIVE * model.RADIUS,
            throttle=0.3,
        )

    sensed = cw.shifts.Sensed(torque=model.TURBINE, throttle="combustion.throttle")
    signals = {"torque": "half_shafts.torque", "acceleration": "car.acceleration"}
    return cw.shifts.survey(in_gear, box, sensed=sensed, rtol=1e-6, **signals)


def write(folder: Path) -> list[Path]:
    """A table and a picture for each box; the drive of the example, its table of shifts and that of its faults."""
    folder.mkdir(parents=True, exist_ok=True)
    made = []
    for name in BOXES:
        found = survey(name)
        (folder / f"{name}.txt").write_text(f"{found}\n", encoding="utf-8")
        found.overview(folder / f"{name}.png")
        made += [folder / f"{name}.txt", folder / f"{name}.png"]
    run, control = eight_speed.drive()
    shifts = eight_speed.quality(run, control.box)
    eight_speed.pictures(run, control.box, shifts, folder)
    (folder / "drive.txt").write_text(f"{cw.shifts.table(shifts)}\n", encoding="utf-8")
    (folder / "faults.txt").write_text(f"{eight_speed.faults()}\n", encoding="utf-8")
    names = (
        "drive.png",
        "jerk.png",
        "shift_2_3.png",
        "shifts.png",
        "drive.txt",
        "faults.txt",
    )
    return [*made, *(folder / name for name in names)]
