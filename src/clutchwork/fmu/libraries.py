"""The libraries of FMUs that this installation has, by platform."""

from __future__ import annotations

import gzip
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from clutchwork.declare.core import core

# what the build installs beside the compiled core, CMakeLists.txt
INSTALLED = ("native", "fmu")
# those of other platforms, `make fmu-libraries`: packed, so that no tool takes them for libraries of this one
OTHERS = Path(__file__).parent / "static"
PACKED = ".gz"
SYSTEMS = {"linux": ("linux", ".so"), "windows": ("win", ".dll"), "darwin": ("darwin", ".dylib")}
PROCESSORS = {"x86_64": "64", "amd64": "64", "aarch64": "aarch64", "arm64": "aarch64"}


class Library(NamedTuple):
    """A library for one platform, with the folders that the versions of FMI have for it."""

    path: Path
    ending: str
    folders: dict[str, str]  # by version

    def content(self) -> bytes:
        """Its bytes."""
        found = self.path.read_bytes()
        return gzip.decompress(found) if self.path.suffix == PACKED else found


def folder() -> Path:
    """Where that of this platform is."""
    return Path(core().__file__).parent.joinpath(*INSTALLED)


def libraries() -> list[Library]:
    """All that were built, of each platform one; FileNotFoundError where there is none."""
    found = {one.folders["3.0"]: one for one in (*_others(), *_libraries(folder()))}
    if not any(one.path.suffix != PACKED for one in found.values()):
        raise FileNotFoundError(f"{folder()} holds no library of FMUs: install clutchwork again")
    return [found[platform] for platform in sorted(found)]


def _libraries(where: Path) -> Iterator[Library]:
    for path in sorted(where.glob("*-*.*")):
        made = _library(path, path.stem)
        if made is not None:
            yield made


def _others() -> Iterator[Library]:
    """Those of other platforms that read what this core writes: `x86_64-windows.0123456789abcdef.dll.gz`."""
    for path in sorted(OTHERS.glob(f"*-*.*.*{PACKED}")):
        platform, schema = path.name.split(".")[:2]
        made = _library(path, platform)
        if made is not None and schema == schema_of(core().schema_hash()):
            yield made


def schema_of(number: int) -> str:
    """A schema in the name of a file."""
    return f"{number & (2**64 - 1):016x}"


def _library(path: Path, platform: str) -> Library | None:
    processor, _, system = platform.partition("-")
    if system not in SYSTEMS or processor not in PROCESSORS:
        return None
    short, ending = SYSTEMS[system]
    whole = "x86_64" if PROCESSORS[processor] == "64" else "aarch64"
    # FMI 2.0 has names for the processors of its time alone; tools that run elsewhere look for these
    two = f"{short}64" if whole == "x86_64" or system == "darwin" else f"aarch64-{system}"
    return Library(path, ending, {"2.0": two, "3.0": f"{whole}-{system}"})
