"""The library of FMUs for other platforms, where an emulator runs it: the bits of this platform's.

`make fmu-libraries` builds them; qemu-user runs the one for aarch64, Wine the one for Windows. docs/guide/fmu.md
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import struct
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.fmu.libraries import libraries
from support.fmus import Fmu
from support.project import ROOT

from .conftest import INPUTS, OUTPUTS, SIX_SPEED

SOURCE = ROOT / "tests" / "support" / "foreign_master.c"
STEP, STEPS = 1e-2, 100
INPUT, PRESSURE = "F1.pressure", 2e5


@dataclass(frozen=True)
class Platform:
    """One that runs here in an emulator."""

    target: str
    ending: str
    commands: tuple[str, ...]
    # behind the command
    options: tuple[str, ...] = ()
    # what of that platform the emulator needs
    needs: str = "/"

    def emulator(self) -> list[str]:
        """The command, empty where it is not installed."""
        found = next(filter(None, map(shutil.which, self.commands)), None)
        return [found, *self.options] if found and Path(self.needs).exists() else []


# Debian: qemu-user with libc6-arm64-cross, wine64
ARM = "/usr/aarch64-linux-gnu"
PLATFORMS = {
    "aarch64-linux": Platform(
        "aarch64-linux-gnu.2.17", "", ("qemu-aarch64", "qemu-aarch64-static"), ("-L", ARM), f"{ARM}/lib"
    ),
    "x86_64-windows": Platform("x86_64-windows-gnu", ".exe", ("wine64", "wine", "/usr/lib/wine/wine64")),
}
BUILT = {library.folders["3.0"] for library in libraries()}
HAS_COMPILER = importlib.util.find_spec("ziglang") is not None


@pytest.mark.parametrize("name", PLATFORMS)
def test_the_bits_of_this_platform(tmp_path: Path, name: str) -> None:
    """A shift with events, states and a flexible shaft: everything that a library computes is its own."""
    platform = PLATFORMS[name]
    emulator = platform.emulator()
    processor, _, system = name.partition("-")
    if not emulator or f"{processor}-{system}" not in BUILT or not HAS_COMPILER:
        pytest.skip(f"needs an emulator, `make fmu-libraries PLATFORMS={name}` and the extra wasm")
    path = cw.Driveline.load(SIX_SPEED).to_fmu(
        tmp_path / "six.fmu", inputs=INPUTS, outputs=OUTPUTS, version="3.0", picture=False
    )
    fmu = Fmu(path, tmp_path / "unpacked")
    names = [one for one, about in fmu.variables.items() if about.causality == "output" and about.type == "Float64"]
    with fmu.running({INPUT: PRESSURE}) as here:
        for k in range(STEPS):
            here.step(k * STEP, STEP)
        want = here.get(names)
        # as a C program takes them
        inputs, outputs = [here.reference(INPUT), PRESSURE], [here.reference(one) for one in names]
    library = next((fmu.folder / "binaries" / name).iterdir())
    words = [library, fmu.description.guid, f"{fmu.folder / 'resources'}/", STEP, STEPS, *inputs, *outputs]
    lines = _run([*emulator, _compiled(tmp_path, platform), *words], tmp_path)
    found = struct.unpack(f"<{len(names)}d", b"".join(int(line, 16).to_bytes(8, "little") for line in lines))
    assert any(found)
    assert dict(zip(names, found, strict=True)) == dict(zip(names, want, strict=True))


def _compiled(folder: Path, platform: Platform) -> Path:
    """The master for that platform."""
    made = folder / f"master{platform.ending}"
    compiler = [sys.executable, "-m", "ziglang", "cc", "-target", platform.target, "-O1"]
    subprocess.run([*compiler, SOURCE, "-o", made, *(() if platform.ending else ("-ldl",))], check=True)
    return made


def _run(command: list[Any], folder: Path) -> list[str]:
    """What it prints, line by line; Wine talks of itself beside it."""
    environment = {**os.environ, "WINEDEBUG": "-all", "WINEPREFIX": str(folder / "wine")}
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, env=environment, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()
