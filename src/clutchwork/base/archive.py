"""Archives of named parts that are read with care: sizes are bounded, and damage is found by checksums."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from clutchwork.base.regular import read_regular
from clutchwork.base.writing import replaced

MOST_BYTES = 256_000_000
# whatever is the same in all archives of the same content
EPOCH = (1980, 1, 1, 0, 0, 0)


def write(path: str | Path, parts: Mapping[str, bytes]) -> None:
    """Write an archive."""
    with replaced(Path(path)) as new, zipfile.ZipFile(new, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in parts.items():
            archive.writestr(zipfile.ZipInfo(name, EPOCH), data, zipfile.ZIP_DEFLATED)


def read(path: str | Path, names: Sequence[str], most: int = 0) -> list[bytes]:
    """The parts of an archive; ValueError says why there are none, OSError that it cannot be read.

    Parameters: most, bytes that it may have, MOST_BYTES by default.
    """
    most = most or MOST_BYTES
    data = read_regular(path, most)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            there = {item.filename: item for item in archive.infolist()}
            missing = [name for name in names if name not in there]
            if missing or len(there) != len(names):
                raise ValueError("it has other parts")
            # a part never gives more than the size that its head says
            if sum(there[name].file_size for name in names) > most:
                raise ValueError(f"it unpacks to more than {most} bytes")
            return [archive.read(there[name]) for name in names]
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError):
        raise ValueError("it is damaged or not an archive") from None
