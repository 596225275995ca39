"""Draw the pictures of the stories of the guide: their own programs write them."""

from __future__ import annotations

import contextlib
import io
import re
import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

from groups import ROOT, STORIES, programs


def page(name: str) -> Path:
    """The page of a story."""
    return ROOT / "docs" / "guide" / f"{name}.md"


def pictures(name: str) -> list[str]:
    """The pictures of its own that a page shows."""
    text = page(name).read_text(encoding="utf-8")
    return re.findall(rf"pictures/stories/{name}/([\w.]+)", text)


def write(folder: Path) -> list[Path]:
    """Run the programs of each page in a folder of its own."""
    return [path for name in STORIES for path in told(name, folder / name)]


def told(name: str, folder: Path) -> list[Path]:
    """Run the programs of a page in a folder that looks like the root of a clone."""
    folder.mkdir(parents=True, exist_ok=True)
    blocks = [
        program.replace('"examples/', f'"{ROOT.as_posix()}/examples/')
        for program in programs(name)
    ]
    before = list(sys.path)
    # what the programs print is for their readers
    with contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
        exec("\n".join(blocks), {})
    sys.path[:] = before
    return [folder / made for made in pictures(name)]
