"""Where an FMU has its library for this machine."""

from __future__ import annotations

import platform
import sys
from collections.abc import Sequence

from clutchwork.base import FMUError
from clutchwork.fmu_import.description import Description

ENDINGS = {"linux": ".so", "win32": ".dll", "darwin": ".dylib"}
TWO = {"linux": "linux", "win32": "win", "darwin": "darwin"}
THREE = {"linux": "linux", "win32": "windows", "darwin": "darwin"}
PROCESSORS = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "aarch64", "aarch64": "aarch64"}


def library_of(made: Description, names: Sequence[str]) -> str:
    """The entry with the library for this machine; FMUError names the platforms that there are."""
    known = places(made.version, made.identifier)
    found = next((name for name in known if name in names), None)
    if found is None:
        there = sorted({name.split("/")[1] for name in names if name.startswith("binaries/") and name.count("/") > 1})
        has = f"it has those of {', '.join(there)}" if there else "it has no library at all"
        raise FMUError(f"it has no library {known[0]} for this machine; {has}")
    return found


def places(version: str, identifier: str) -> list[str]:
    """Entries that may be the library for this machine, the one of the standard first."""
    ending = ENDINGS.get(sys.platform, ".so")
    return [f"binaries/{folder}/{identifier}{ending}" for folder in _folders(version)]


def _folders(version: str) -> list[str]:
    """Folders for this machine, the likely one first."""
    processor = PROCESSORS.get(platform.machine().lower(), platform.machine().lower())
    system = sys.platform
    three = f"{processor}-{THREE.get(system, system)}"
    if version == "3.0":
        return [three]
    # FMI 2.0 names the processors of its time alone
    return [f"{TWO.get(system, system)}64", three] if processor == "x86_64" else [three, f"{TWO.get(system, system)}64"]
