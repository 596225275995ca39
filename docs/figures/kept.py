"""Pictures that are drawn anew only when something has changed that they may depend on."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path

import stories

import clutchwork
from clutchwork.declare.core import core

ROOT = Path(__file__).resolve().parents[2]
PAGES = (*stories.PAGES, "linearise", "pictures")


@cache
def fingerprint() -> str:
    """Fingerprint of the package, its core, the examples and what draws."""
    folders = (
        Path(clutchwork.__file__).parent,
        ROOT / "examples",
        ROOT / "docs" / "figures",
        ROOT / "tools",
    )
    files = [
        Path(core().__file__),
        # their programs draw their pictures
        *(ROOT / "docs" / "guide" / f"{name}.md" for name in PAGES),
        *(file for folder in folders for file in sorted(folder.rglob("*.py"))),
        *sorted(Path(clutchwork.__file__).parent.rglob("gearbox/catalogue/*.toml")),
    ]
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def write(
    draw: Callable[[Path], list[Path]], folder: Path, also: Iterable[Path] = ()
) -> None:
    """Let a function write its pictures into a folder, unless those there are of the same fingerprint.

    Parameters: also, other files that they depend on.
    """
    mark = folder / "fingerprint"
    known = [hashlib.sha256(file.read_bytes()).hexdigest() for file in sorted(also)]
    now = " ".join([fingerprint(), *known])
    if mark.exists() and mark.read_text() == now:
        return
    draw(folder)
    mark.write_text(now)
