"""Import, and on request build and tests."""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from benchmarks.report import Row
from support import project

IMPORT = "import numpy, time; t = time.perf_counter(); import clutchwork; print(time.perf_counter() - t)"


def importing(repeats: int) -> float:
    """Time that `import clutchwork` takes after numpy, in fresh interpreters [s]."""
    command = [sys.executable, "-c", IMPORT]
    return statistics.median(
        float(subprocess.run(command, capture_output=True, text=True, check=True).stdout) for _ in range(repeats)
    )


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
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
