"""Archives of named parts that are read with care: sizes are bounded, and damage is found by checksums."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from clutchwork.base.regular import read_regular
from clutchwork.base.writing import replaced

MOST_BYTES = 256_000_000
# instants, events and models shrink to a tenth at most
MOST_PACKED, LEAST_BOUND = 100, 4_000_000
# whatever is the same in all archives of the same content
EPOCH = (1980, 1, 1, 0, 0, 0)


def write(path: str | Path, parts: Mapping[str, bytes]) -> None:
    """Write an archive."""
    with replaced(Path(path)) as new, zipfile.ZipFile(new, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in parts.items():
            archive.writestr(zipfile.ZipInfo(name, EPOCH), data, zipfile.ZIP_DEFLATED)


def read(path: str | Path, names: Sequence[str]) -> list[bytes]:
    """The parts of a small archive; ValueError says why there are none, OSError that it cannot be read."""
    parts = ArchiveParts(path, names, MOST_BYTES)
    # a part never gives more than the size that its head says
    if sum(map(parts.size, names)) > MOST_BYTES:
        raise ValueError(f"it unpacks to more than {MOST_BYTES} bytes")
    return [parts.read(name) for name in names]


class ArchiveParts:
    """The parts of an archive, each unpacked when it is asked for; ValueError and OSError as for `read`."""

    def __init__(self, path: str | Path, names: Sequence[str], most: int) -> None:
        """Look into an archive of at most so many bytes, packed."""
        data = read_regular(path, most)
        with _sound():
            self._archive = zipfile.ZipFile(io.BytesIO(data))
        self._there = {item.filename: item for item in self._archive.infolist()}
        if [name for name in names if name not in self._there] or len(self._there) != len(names):
            raise ValueError("it has other parts")

    def size(self, name: str) -> int:
        """Bytes of a part, unpacked."""
        return self._there[name].file_size

    def read(self, name: str) -> bytes:
        """A part, unpacked."""
        with _sound():
            return self._archive.read(self._there[name])

    def probable(self, name: str) -> bytes:
        """A part, unpacked where its size is one that numbers and words can have, packed so small."""
        packed, size = self._there[name].compress_size, self.size(name)
        if size > LEAST_BOUND + MOST_PACKED * packed:
            raise ValueError(f"its part {name} unpacks {packed} bytes to {size}, more than a run can hold in them")
        return self.read(name)


@contextmanager
def _sound() -> Iterator[None]:
    try:
        yield
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError):
        raise ValueError("it is damaged or not an archive") from None
