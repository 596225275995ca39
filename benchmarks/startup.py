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


READY = """
import time
import clutchwork as cw
def taken():
    start = time.process_time()
    driveline = cw.Driveline.load("examples/six_speed/model.toml")
    driveline.check()
    driveline.assemble()
    return time.process_time() - start
print(min(taken() for _ in range(100)))
"""
HELP = """
import resource, subprocess, sys
command = [sys.executable, "-m", "clutchwork", "--help"]
subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(used.ru_utime + used.ru_stime)
"""
# what is measured, its program, and the most that it should take [ms]
ROWS = (
    ("import clutchwork, above numpy, warm bytecode", IMPORT, 20.0),
    ("first simulate of a process, above the second", FIRST, 5.0),
    ("load, check and assemble the six-speed gearbox", READY, 1.5),
    ("clutchwork --help, the interpreter included", HELP, 120.0),
)


def fresh(code: str, repeats: int) -> float:
    """Median of the CPU time that a program prints in fresh interpreters that find their bytecode [s]."""
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


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    for what, code, most in ROWS:
        taken = 1e3 * fresh(code, 5 if quick else 15)
        yield Row(f"{what}, CPU", f"{taken:.1f} ms", f"<= {most:g} ms", taken <= most)


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
