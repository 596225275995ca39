"""Draw the pictures of the rig."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl

mpl.use("agg")
from clutchwork import rig


def write(folder: Path) -> list[Path]:
    """Perform every experiment with its own laws and preset, and write its picture."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for name in rig.EXPERIMENTS:
        paths.append(folder / f"{name}.png")
        getattr(rig, name)().plot(paths[-1])
    return paths
