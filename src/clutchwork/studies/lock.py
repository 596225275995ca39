"""One process at a time adds to a data set; the system releases the lock of one that is killed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from clutchwork.studies.manifest import StudyError

FILE = ".lock"


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder; StudyError where another process does."""
    try:
        # not on Windows
        import fcntl
    except ImportError:
        # parts are complete nevertheless
        yield
        return
    with (folder / FILE).open("w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            remedy = "wait until it is done, or end it"
            raise StudyError(f"{folder}: another process is running this study; {remedy}") from None
        yield
