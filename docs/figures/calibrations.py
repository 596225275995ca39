"""Draw the picture of the calibration."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")
sys.path[:0] = [
    str(Path(__file__).resolve().parents[2] / "examples" / "calibrate_shift")
]

import calibrate_shift  # noqa: E402


def write(folder: Path) -> list[Path]:
    """Calibrate the shift of the eight-speed box for nominal linings; before and after, and the front."""
    folder.mkdir(parents=True, exist_ok=True)
    path, front = folder / "calibrate_shift.png", folder / "calibrate_shift_front.png"
    shift = calibrate_shift.eight_speed()
    nominal = calibrate_shift.calibrated(shift)
    nominal.front(f"{shift.clutches[0]}.heat", shift.heats[::2]).plot(front)
    nominal.plot(*shift.shown, path=path)
    return [path, front]
