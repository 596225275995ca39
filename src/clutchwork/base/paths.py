"""Paths that calls are given: one check for all, and one way to make the folder that a file goes into."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from clutchwork.base.errors import ClutchworkError, UseError
from clutchwork.base.quote import listed, quote


class WriteError(ClutchworkError, OSError):
    """A file or folder that cannot be written, with what to do."""


def path_of(call: str, path: object, example: str) -> Path:
    """A path that is one; UseError with an example where it is something else."""
    if not isinstance(path, str | os.PathLike) or not _is_path(path):
        raise UseError(call, [_no_path(path, example)])
    return Path(path)


def _is_path(path: object) -> bool:
    return isinstance(path, str | os.PathLike) and isinstance(os.fspath(path), str)


def _no_path(path: object, example: str) -> str:
    return f"{quote(path)} is not a path; give a string, such as {example!r}"


def path_fault(path: object, example: str) -> str:
    """What is wrong with it as the path of a file that is to be written, empty where nothing is."""
    if not _is_path(path):
        return _no_path(path, example)
    if not str(path):
        return f"the path is empty; give the name of a file, such as {example!r}"
    if "\0" in str(path):
        return f"{quote(str(path))}: not a valid file name; give one such as {example!r}"
    return ""


def fitting(call: str, path: object, example: str, endings: Sequence[str] = ()) -> Path:
    """The path of a file that is to be written, not made yet; UseError for no path or a wrong ending."""
    if fault := path_fault(path, example):
        raise UseError(call, [fault])
    where = path_of(call, path, example)
    # a name without an ending says nothing wrong
    if endings and where.suffix and where.suffix.lower() not in endings:
        fault = f"{quote(str(where))} ends in {quote(where.suffix)}, and what is written is {listed(endings)}"
        raise UseError(call, [f"{fault}; give a path such as {example!r}"])
    return where


def made(path: Path) -> Path:
    """The same path of a file; its folder is made where it is missing. WriteError where that cannot be."""
    if path.is_dir():
        raise WriteError(f"{path}: cannot be written: it is a folder; give a file in it")
    folder(path.parent)
    return path


def folder(path: Path) -> Path:
    """The same path of a folder, made where it is missing; WriteError where that cannot be."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        there = next(one for one in (path, *path.parents) if one.exists())
        raise WriteError(f"{path}: cannot be made: {there} is a file, not a folder; give another path") from None
    except OSError as error:
        why = (error.strerror or type(error).__name__).lower()
        raise WriteError(f"{path}: cannot be made: {why}; give another folder") from None
    return path
