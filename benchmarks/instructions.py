"""Derivatives over plain runs by instructions, which no load of a machine changes; valgrind counts them.

python -m benchmarks instructions          the table
python -m benchmarks.instructions NAME 22  so many calls, to be counted
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from benchmarks import gradients  # noqa: E402
from benchmarks.report import Row  # noqa: E402

VALGRIND = ("valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null")
# calls of two processes, whose difference has no start in it
FEW, MANY = 2, 22


def counted(name: str, calls: int) -> int:
    """Instructions of a process."""
    command = [*VALGRIND, sys.executable, "-m", "benchmarks.instructions", name, str(calls)]
    same = {**os.environ, "PYTHONHASHSEED": "0"}
    told = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT, env=same).stderr
    return int(told.rpartition("refs:")[2].split()[0].replace(",", ""))


@cache
def of_call(name: str) -> float:
    """Instructions of one call."""
    return (counted(name, MANY) - counted(name, FEW)) / (MANY - FEW)


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table; they are the same for any number of rounds."""
    del quick
    if shutil.which(VALGRIND[0]) is None:
        yield Row("gradients by instructions", "not installed: apt install valgrind")
        return
    # what the first process of all writes down for the others, such as bytecode, is not counted
    counted("shift", FEW)
    yield from gradients.compared("instructions", lambda name, plain: of_call(name) / of_call(plain))


def main(name: str, count: str) -> None:
    """Call it so often."""
    call = gradients.calls()[name]
    for _ in range(int(count)):
        call()


if __name__ == "__main__":
    main(*sys.argv[1:])
