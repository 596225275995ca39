"""Draw the picture of the calibration for the documentation, whose build calls this; it is never committed."""

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
    """Calibrate the shift of the eight-speed box, with fewer samples than the example, and draw it before and after."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "calibrate_shift.png"
    shift = calibrate_shift.eight_speed()
    calibrate_shift.calibrated(shift, samples=16).plot(*shift.shown, path=path)
    return [path]
