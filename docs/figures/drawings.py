"""Draw the pictures of the guide for the documentation, whose build calls this: its own programs write them."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")
import clutchwork as cw
from clutchwork.face.laws import parts as law_parts

PAGE = Path(__file__).resolve().parents[1] / "guide" / "pictures.md"
WRITTEN = ("launch.png", "named.png", "zoom.svg", "compare.png")


def write(folder: Path) -> list[Path]:
    """Run the programs of the page in a folder, and draw a law as a notebook shows it."""
    folder.mkdir(parents=True, exist_ok=True)
    programs = re.findall(
        r"^```python\n(.*?)^```",
        PAGE.read_text(encoding="utf-8"),
        re.DOTALL | re.MULTILINE,
    )
    with contextlib.chdir(folder):
        exec("\n".join(programs), {})
    law = cw.Stribeck(static=0.14, kinetic=0.1, speed=15.0)
    drawn, _ = law_parts(law)
    assert drawn is not None
    (folder / "law.png").write_bytes(drawn.png())
    return [folder / name for name in (*WRITTEN, "law.png")]
