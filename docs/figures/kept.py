"""Files that are made anew only when something has changed that they may depend on, by all cores."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path


def fingerprint(files: Iterable[Path]) -> str:
    """Fingerprint of files, or of all files of folders."""
    found = [
        file
        for path in files
        for file in ([path] if path.is_file() else path.rglob("*.*"))
    ]
    known = sorted(
        {
            file
            for file in found
            if file.is_file() and file.suffix not in (".pyc", ".pyi")
        }
    )
    return hashlib.sha256(b"".join(file.read_bytes() for file in known)).hexdigest()


def write(
    makes: Callable[[str, Path], None], paths: Iterable[Path], files: Iterable[Path]
) -> None:
    """Let a function make each file by its stem, unless it is there and what all are made from has not changed.

    Parameters: paths, what to make, in one folder; files, what they are made from.
    """
    wanted = list(paths)
    mark = wanted[0].parent / f"{makes.__name__}.fingerprint"
    now = fingerprint(files)
    kept = mark.exists() and mark.read_text() == now
    todo = [path for path in wanted if not (kept and path.exists())]
    if not todo:
        return
    mark.parent.mkdir(parents=True, exist_ok=True)
    mark.unlink(missing_ok=True)
    each([(makes, path.stem, path) for path in todo])
    mark.write_text(now)


def each(calls: Iterable[tuple[Callable[..., None], *tuple[object, ...]]]) -> None:
    """Call functions, each with what follows it, in as many processes as there are cores."""
    todo = list(calls)
    workers = min(int(os.environ.get("JOBS") or os.cpu_count() or 1), len(todo))
    with ProcessPoolExecutor(workers, get_context("spawn")) as pool:
        for done in [pool.submit(*call) for call in todo]:
            done.result()
