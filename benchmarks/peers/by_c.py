"""Peers that are compiled here: CVODE all in C, and floor.cpp, written by hand for this one model."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from importlib import util
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.peers import equations
from benchmarks.peers.driver import FOLDER

ROOT = Path(__file__).resolve().parents[2]
MISSING = "not installed: apt install libsundials-dev, or pip install scikit-sundae"
METHODS = {"Adams": 1, "BDF": 2}
# what cvode.c calls, and what that needs
LIBRARIES = ("cvode", "nvecserial", "sunmatrixdense", "sunlinsoldense", "core")
NUMBERS = ("GAINS", "STIFFNESS", "DAMPING", "STATIC", "KNEE", "FAST", "MORE", "RATE")
TABLES = ("KNOTS", "PRESSURES", "SLOPES", "SLIPS", "MASS_INVERSE", "ACCELERATIONS", "MULTIPLIERS")


class NotInstalledError(Exception):
    """A compiler or a library is missing; its message says which, and what to do."""


def header() -> Iterator[str]:
    """The numbers of the equations for C."""
    yield f"enum {{ STRETCHES = {len(equations.PRESSURES)} }};"
    for name in (*NUMBERS, *TABLES):
        array = np.array(getattr(equations, name), dtype=float)
        sizes = "".join(f"[{size}]" for size in array.shape)
        yield f"static const double {name}{sizes} = {_braced(array.tolist())};"


def _braced(value: Any) -> str:
    return "{" + ", ".join(map(_braced, value)) + "}" if isinstance(value, list) else repr(value)


def cvode(folder: Path) -> Path:
    """Build cvode.c; the program."""
    (folder / "gearbox.h").write_text("\n".join(header()) + "\n")
    program, source = folder / "cvode", str(FOLDER / "cvode.c")
    for libraries in (_of_wheel(), [f"-lsundials_{name}" for name in LIBRARIES], _system_without_core()):
        if libraries and _compiled("cc", ["-std=gnu11", "-O3", f"-I{folder}", source], program, libraries):
            return program
    raise NotInstalledError(MISSING)


def _system_without_core() -> list[str]:
    # a library of its own since version 7
    return [f"-lsundials_{name}" for name in LIBRARIES if name != "core"]


def _of_wheel() -> list[str]:
    """The libraries inside the wheel of scikit-sundae, where it is installed and is a wheel."""
    found = util.find_spec("sksundae")
    if found is None or found.origin is None:
        return []
    folder = Path(found.origin).parents[1] / "scikit_sundae.libs"
    paths = [next(iter(folder.glob(f"libsundials_{name}-*.so*")), None) for name in LIBRARIES]
    return [] if None in paths else [*map(str, paths), f"-Wl,-rpath,{folder}", "-Wl,--allow-shlib-undefined"]


def _compiled(compiler: str, sources: list[str], program: Path, libraries: list[str]) -> bool:
    path = shutil.which(compiler)
    if path is None:
        raise NotInstalledError(f"not installed: a compiler, {compiler}")
    command = [path, *sources, "-o", str(program), *libraries, "-lm"]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


def cvode_seconds(program: Path, method: str, rtol: float = 1e-6, repeats: int = 50) -> float:
    """Median CPU time of one run [s]."""
    return 1e-6 * float(_said(program, str(METHODS[method]), f"{rtol:g}", str(repeats)).split()[0])


def cvode_states(program: Path, method: str, rtol: float = 1e-6) -> np.ndarray:
    """The states on the grid of the reference."""
    return np.array(
        [line.split() for line in _said(program, str(METHODS[method]), f"{rtol:g}").splitlines()], dtype=float
    )


def _said(program: Path, *words: str) -> str:
    return subprocess.run([str(program), *words], capture_output=True, text=True, check=True).stdout


def core_objects() -> list[str]:
    """The compiled core of the newest build, in the order in which it is linked; nothing where there is none."""
    newest = max((ROOT / "build").glob("cp3*/core_objects.txt"), key=lambda path: path.stat().st_mtime, default=None)
    return [] if newest is None else newest.read_text(encoding="utf-8").split()


class Pair(NamedTuple):
    """The core and floor.cpp in turns: CPU times of a run [s], the median of their ratios, instructions of a run."""

    core_tenth: float
    core: float
    floor_tenth: float
    floor: float
    ratio: float
    core_instructions: int  # 0: this machine does not count them
    floor_instructions: int


def pair(folder: Path) -> Path:
    """Build pair.cpp; the program."""
    objects, program = core_objects(), folder / "pair"
    source = ["-O3", "-std=c++20", "-pthread", "-w", f"-I{ROOT / 'cpp/include'}", str(FOLDER / "pair.cpp")]
    if not objects or not _compiled("c++", source, program, objects):
        raise NotInstalledError("not installed: a C++20 compiler, c++, and a build of the core, make setup")
    return program


def paired(program: Path, system: Path, t_end: float, turns: int) -> dict[str, Pair]:
    """What they take for the shift of a System at rtol 1e-6, by method."""
    found = {}
    for line in _said(program, str(system), f"{t_end:g}", str(turns)).splitlines():
        method, *numbers, own, other = line.split()
        *times, share = map(float, numbers)
        found[method] = Pair(*(1e-6 * time for time in times), share, int(own), int(other))
    return found
