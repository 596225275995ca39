"""Files that are opened for reading: regular ones only, of a size that fits."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import BinaryIO

PIECE = 1_000_000


class UnfitFileError(OSError):
    """A path that leads to no regular file, or to one that is too large."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.strerror = reason


def open_regular(path: str | Path, most: int) -> BinaryIO:
    """Open a regular file for reading; UnfitFileError for folders, devices, pipes and files of more than `most` bytes.

    A path that cannot be one, such as one with a NUL, is an OSError too.
    """
    try:
        # a pipe without a writer would wait for one
        number = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0))
    except ValueError as error:
        raise UnfitFileError("is not a valid file name") from error
    found = os.fstat(number)
    if not stat.S_ISREG(found.st_mode):
        fault = "is not a regular file"
    elif found.st_size > most:
        fault = f"has {found.st_size} bytes, more than {most}"
    else:
        return os.fdopen(number, "rb")
    os.close(number)
    raise UnfitFileError(fault)


def read_regular(path: str | Path, most: int) -> bytes:
    """All bytes of a regular file."""
    data = bytearray()
    with open_regular(path, most) as stream:
        # as much memory as there is to read, not as there may be
        while piece := stream.read(PIECE):
            data += piece
            if len(data) > most:
                raise UnfitFileError(f"has more than {most} bytes")
    return bytes(data)


def reason(error: OSError) -> str:
    """Why a file cannot be read, without its content."""
    return error.strerror or type(error).__name__
