"""Draw the pictures of the stories of the guide for the documentation, whose build calls this: their own programs write them."""

from __future__ import annotations

import contextlib
import io
import re
import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("start", "thermal-launch", "wet-clutch", "shift-controller", "learn")


def page(name: str) -> Path:
    """The page of a story."""
    return ROOT / "docs" / "guide" / f"{name}.md"


def pictures(name: str) -> list[str]:
    """The pictures of its own that a page shows."""
    text = page(name).read_text(encoding="utf-8")
    return re.findall(rf"reference/stories/{name}/([\w.]+)", text)


def write(folder: Path) -> list[Path]:
    """Run the programs of each page in a folder of its own."""
    return [path for name in PAGES for path in told(name, folder / name)]


def told(name: str, folder: Path) -> list[Path]:
    """Run the programs of a page in a folder that looks like the root of a clone."""
    folder.mkdir(parents=True, exist_ok=True)
    text = page(name).read_text(encoding="utf-8")
    programs = re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    programs = [
        program.replace('"examples/', f'"{ROOT.as_posix()}/examples/')
        for program in programs
    ]
    before = list(sys.path)
    # what the programs print is for their readers
    with contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
        exec("\n".join(programs), {})
    sys.path[:] = before
    return [folder / made for made in pictures(name)]
