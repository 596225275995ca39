"""Draw the picture of the sweep."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")
sys.path[:0] = [str(Path(__file__).resolve().parents[2] / "examples" / "shift_sweep")]

import shift_sweep  # noqa: E402


def write(folder: Path) -> list[Path]:
    """Perform the shifts, on a coarser grid than the example, and write the picture."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "shift_sweep.png"
    shift_sweep.picture(shift_sweep.shifts(13, 10, 2), path)
    return [path]
