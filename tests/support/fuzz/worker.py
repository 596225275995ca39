"""Run random cases in a process of its own, which has little memory and ends what takes long.

PYTHONPATH=tests python -m support.fuzz.worker model_file 0 20000
"""

from __future__ import annotations

import contextlib
import resource
import signal
import sys
import tempfile
import traceback
import warnings
from pathlib import Path
from random import Random

import clutchwork as cw
from support.fuzz.cases import CASES

SECONDS = 2.0  # of the processor, so that a busy machine does not matter
MEMORY = 500_000_000


class TooLongError(BaseException):
    """A case that does not come to an end."""


def _stop(*_: object) -> None:
    raise TooLongError


def main(kind: str, first: int, count: int) -> int:
    """Print what goes wrong in each case of a kind; the number of these."""
    failed = 0
    signal.signal(signal.SIGPROF, _stop)
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        # everything that is made once
        _run(kind, Path(folder), -1)
        _limit_memory()
        for number in range(first, first + count):
            fault = _run(kind, Path(folder), number)
            if fault:
                failed += 1
                print(f"{kind} {number}: {fault}", flush=True)
    return failed


def _run(kind: str, folder: Path, number: int) -> str:
    random = Random(f"{kind} {number}")
    try:
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        with contextlib.suppress(cw.ClutchworkError):
            CASES[kind](folder, random)
    except (Exception, TooLongError):
        return traceback.format_exc()
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    return ""


def _limit_memory() -> None:
    """Let this process take so much more memory than it has."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit = pages * resource.getpagesize() + MEMORY
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])) > 0)
