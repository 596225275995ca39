"""Import, and on request build and tests."""

from __future__ import annotations

import os
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

IMPORT = "import numpy, time; t = time.process_time(); import clutchwork; print(time.process_time() - t)"
FIRST = """
import sys, time
sys.path.append("tests")
import clutchwork as cw
from support import six_speed
system = six_speed.gearbox(six_speed.SHIFT).assemble()
def timed():
    start = time.process_time()
    cw.simulate(system, 4.0)
    return time.process_time() - start
print(timed() - timed())
"""


def fresh(code: str, repeats: int) -> float:
    """Median of what a program prints in fresh interpreters that find its bytecode [s]."""
    with tempfile.TemporaryDirectory() as cache:
        # what forbids bytecode in this environment would count compiling too
        kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        command = [sys.executable, "-c", code]
        told = [
            subprocess.run(
                command,
                capture_output=True,
                text=True,
                check=True,
                cwd=project.ROOT,
                env=kept | {"PYTHONPYCACHEPREFIX": cache},
            ).stdout
            for _ in range(1 + repeats)
        ]
    return statistics.median(map(float, told[1:]))


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
    taken = fresh(IMPORT, 5 if quick else 15)
    yield Row("import clutchwork, above numpy, warm bytecode", f"{1e3 * taken:.0f} ms", "<= 25 ms", taken <= 0.025)
    taken = fresh(FIRST, 5 if quick else 15)
    words = "first simulate of a process, above the second"
    yield Row(words, f"{1e3 * taken:.1f} ms", "<= 4 ms", taken <= 0.004)


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
