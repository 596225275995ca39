"""Import, and on request build and tests."""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import clutchwork as cw
from benchmarks.report import Row
from support import project

IMPORT = "import numpy, time; t = time.perf_counter(); import clutchwork; print(time.perf_counter() - t)"


def importing(repeats: int) -> float:
    """Time that `import clutchwork` takes after numpy, in fresh interpreters [s]."""
    command = [sys.executable, "-c", IMPORT]
    return statistics.median(
        float(subprocess.run(command, capture_output=True, text=True, check=True).stdout) for _ in range(repeats)
    )


def preparing(repeats: int) -> float:
    """Best time to load, check and assemble the six-speed gearbox, its signals in a CSV file included [s]."""
    path, times = project.ROOT / "examples/six_speed/model.toml", []
    for _ in range(repeats):
        start = time.perf_counter()
        driveline = cw.Driveline.load(path)
        driveline.check()
        driveline.assemble()
        times.append(time.perf_counter() - start)
    return min(times)


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    ready = preparing(50 if quick else 500)
    yield Row("load, check and assemble the six-speed gearbox", f"{1e3 * ready:.1f} ms", "<= 1.5 ms", ready <= 1.5e-3)
    taken = importing(5 if quick else 15)
    yield Row("import clutchwork, above numpy", f"{1e3 * taken:.0f} ms", "<= 60 ms", taken <= 0.06)


def build() -> Iterator[Row]:
    """Clean build of a copy, as `pip install` does it."""
    with tempfile.TemporaryDirectory() as folder:
        copy, site = project.copy(Path(folder) / "project"), Path(folder) / "site"
        command = [
            sys.executable,
            "-m",
            "pip",
            "install",
            "--quiet",
            "--no-build-isolation",
            "--no-deps",
            "--target",
            str(site),
            str(copy),
        ]
        start = time.perf_counter()
        subprocess.run(command, check=True)
        taken = time.perf_counter() - start
    yield Row("clean build", f"{taken:.0f} s", "<= 90 s", taken <= 90)


def tests() -> Iterator[Row]:
    """`make test`, the build left out."""
    start = time.perf_counter()
    passed = subprocess.run(["make", "test"], cwd=project.ROOT, check=False).returncode == 0
    taken = time.perf_counter() - start
    words = f"{taken:.0f} s" if passed else f"{taken:.0f} s, with failures"
    yield Row("make test", words, "<= 300 s", taken <= 300 and passed)
