"""Draw the pictures of the page about pictures: its own programs write them."""

from __future__ import annotations

import contextlib
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")
from groups import programs

import clutchwork as cw
from clutchwork.driveline.laws import parts as law_parts

WRITTEN = ("launch.png", "named.png", "zoom.svg", "compare.png")


def write(folder: Path) -> list[Path]:
    """Run the programs of the page in a folder, and draw a law as a notebook shows it."""
    folder.mkdir(parents=True, exist_ok=True)
    with contextlib.chdir(folder):
        exec("\n".join(programs("pictures")), {})
    law = cw.Stribeck(static=0.14, kinetic=0.1, speed=15.0)
    drawn, _ = law_parts(law)
    assert drawn is not None
    (folder / "law.png").write_bytes(drawn.png())
    return [folder / name for name in (*WRITTEN, "law.png")]
