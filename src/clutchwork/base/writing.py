"""Files that are written: there as a whole, or as they were before. All files of the package are written by these."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from errno import EDQUOT, EFBIG, ENOSPC
from pathlib import Path
from stat import S_IMODE

from clutchwork.base.paths import WriteError, made

FULL = (ENOSPC, EDQUOT, EFBIG)
# of names of files that are not whole yet
NEW = ".new"


def put(path: Path, content: str | bytes) -> Path:
    """Write a file; its path, whose folder is made where it is missing."""
    with replaced(path) as new:
        new.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def put_csv(path: Path, lines: Iterable[Sequence[object]]) -> None:
    """Write lines of cells as CSV; names in them may hold commas and quotes."""
    # few calls write
    import csv

    with replaced(path) as new, new.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(lines)


@contextmanager
def replaced(path: Path) -> Iterator[Path]:
    """A file to write that takes the place of a path once it is whole and on the disk; else nothing changes.

    It is beside the path and has its ending; its folder is made. WriteError says path and remedy where it cannot be.
    """
    path = made(path)
    if path.exists() and not path.is_file():
        # a device or a pipe takes what it is given
        with told(path):
            yield path
        return
    # what a link leads to is written, not the link
    whole = path.resolve()
    new = whole.with_name(f".{os.urandom(8).hex()}{NEW}{whole.suffix}")
    try:
        with told(path):
            if whole.exists() and not os.access(whole, os.W_OK):
                raise PermissionError(None, "you may not change this file")
            yield new
            _settle(new, whole)
    finally:
        with suppress(OSError):
            new.unlink(missing_ok=True)


def _settle(new: Path, whole: Path) -> None:
    with new.open("rb+") as file:
        os.fsync(file.fileno())
    if whole.exists():
        new.chmod(S_IMODE(whole.stat().st_mode))
    new.replace(whole)


@contextmanager
def told(path: Path) -> Iterator[None]:
    """WriteError with path and remedy for what the system says."""
    try:
        yield
    except WriteError:
        raise
    except OSError as error:
        full = error.errno in FULL
        # libraries say more than the system does
        why = (os.strerror(error.errno or 0) if full else error.strerror or str(error)).lower()
        remedy = "make room on the disk" if full else "check the folder"
        raise WriteError(f"{path}: cannot be written: {why}; {remedy}, or give another path") from error
