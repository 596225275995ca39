"""Draw the picture of the studies."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")
sys.path[:0] = [
    str(Path(__file__).resolve().parents[2] / "examples" / "million_shifts")
]

import million_shifts  # noqa: E402

# eight shifts for each; the example makes a million of them
POINTS = 4096


def write(folder: Path) -> list[Path]:
    """Run the study of the example, with fewer points, and draw distributions and Sobol indices."""
    folder.mkdir(parents=True, exist_ok=True)
    data, path = folder / "data", folder / "million_shifts.png"
    million_shifts.picture(million_shifts.study(data, POINTS), path)
    shutil.rmtree(data)
    return [path]
