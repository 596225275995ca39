"""The progress bar of the command line: that of tqdm where it is installed, for runs that are worth waiting for."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import TYPE_CHECKING

from clutchwork.base.progress import MEASURED, followed

if TYPE_CHECKING:
    from clutchwork.run.record import Progress

PATIENCE = 0.5  # s of real time before anything is shown


@contextmanager
def bar(t_start: float, t_end: float, *, hidden: bool = False) -> Iterator[Progress]:
    """A function of (time, t_end) [s] that shows on standard error how far a run is, on a terminal only."""
    wanted = not hidden and sys.stderr.isatty() and find_spec("tqdm") is not None
    looks = {"bar_format": MEASURED, "unit": "s", "delay": PATIENCE, "leave": False}
    with followed(wanted, t_end, "run", "(time, t_end)", t_start, **looks) as shown:
        # a run takes the same stretches with and without progress
        yield lambda time, _: shown(time) if shown else None
