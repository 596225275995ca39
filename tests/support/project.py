"""A copy of the project in a temporary folder, to be changed and built there."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ("pyproject.toml", "CMakeLists.txt", "README.md", "LICENSE", "src", "cpp", "interfaces", "tools")
# neither caches nor anything that an in-place build left
IGNORED = shutil.ignore_patterns("__pycache__", "*.so", "*.egg-info", "build", ".venv", "node_modules", "static")


def copy(to: Path, *more: str) -> Path:
    """The project without build results; its tests and documents only where they are named."""
    to.mkdir(parents=True, exist_ok=True)
    for name in (*SOURCES, *more):
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, to / name, ignore=IGNORED)
        elif source.exists():
            shutil.copy(source, to / name)
    return to


def generate(project: Path, to: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run the generator of a copy; without the site module no editable install gets in its way."""
    command = [
        sys.executable,
        "-I",
        "-S",
        str(project / "tools/gen_registry.py"),
        str(project),
        str(to or project / "gen/clutchwork"),
    ]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def compile_registry(project: Path, code: str = "") -> subprocess.CompletedProcess[str]:
    """Compile the generated headers, and a few lines after them, without making code."""
    unit = project / "gen/unit.cpp"
    unit.write_text(f"#include <clutchwork/registry.gen.hpp>\n{code}")
    include = ["-I", str(project / "cpp/include"), "-I", str(project / "gen")]
    command = ["c++", "-std=c++20", "-fsyntax-only", *include, str(unit)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def install(project: Path, site: Path) -> subprocess.CompletedProcess[str]:
    """Build and install the copy into a folder, compiled fast: the build is the test, not the speed."""
    command = [
        sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-build-isolation",
        "--no-deps", "--no-index", "--target", str(site), "--config-settings", "cmake.build-type=Debug",
        "--config-settings", "cmake.args=-DCMAKE_CXX_FLAGS_DEBUG=-O0;-DCLUTCHWORK_QUICK=ON", str(project),
    ]  # fmt: skip
    return subprocess.run(command, capture_output=True, text=True, check=False)


def run_in(site: Path, *arguments: str, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run Python with arguments such as "-c", code; it sees the package installed in `site` and no other.

    Without the site module no .pth file is read, so that an editable install of the project itself stays out of it.
    """
    packages = str(Path(np.__file__).resolve().parents[1])
    return subprocess.run(
        [sys.executable, "-S", *arguments],
        capture_output=True,
        text=True,
        check=False,
        cwd=folder or site,
        env={**os.environ, "PYTHONPATH": os.pathsep.join((str(site), packages))},
    )


def write_stubs(project: Path, folder: Path) -> None:
    """Write the type stubs of a copy, as the build does."""
    tool = str(project / "tools/gen_stubs.py")
    subprocess.run([sys.executable, "-I", "-S", tool, str(project), str(folder)], check=True)
