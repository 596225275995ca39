"""The libraries of FMUs that this installation has, by platform."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from clutchwork.declare.core import core

# what the build installs beside the compiled core, CMakeLists.txt
INSTALLED = ("native", "fmu")
SYSTEMS = {"linux": ("linux", ".so"), "windows": ("win", ".dll"), "darwin": ("darwin", ".dylib")}
PROCESSORS = {"x86_64": "64", "amd64": "64", "aarch64": "aarch64", "arm64": "aarch64"}


class Library(NamedTuple):
    """A library for one platform, with the folders that the versions of FMI have for it."""

    path: Path
    ending: str
    folders: dict[str, str]  # by version


def folder() -> Path:
    """Where they are."""
    return Path(core().__file__).parent.joinpath(*INSTALLED)


def libraries() -> list[Library]:
    """All that were built; FileNotFoundError where there is none."""
    found = [made for path in sorted(folder().glob("*-*.*")) if (made := _library(path)) is not None]
    if not found:
        raise FileNotFoundError(f"{folder()} holds no library of FMUs: install clutchwork again")
    return found


def _library(path: Path) -> Library | None:
    processor, _, system = path.stem.partition("-")
    if system not in SYSTEMS or processor not in PROCESSORS:
        return None
    short, ending = SYSTEMS[system]
    whole = "x86_64" if PROCESSORS[processor] == "64" else "aarch64"
    # FMI 2.0 has names for the processors of its time alone; tools that run elsewhere look for these
    two = f"{short}64" if whole == "x86_64" or system == "darwin" else f"aarch64-{system}"
    return Library(path, ending, {"2.0": two, "3.0": f"{whole}-{system}"})
