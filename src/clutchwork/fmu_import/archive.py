"""The archive of an FMU of other people, unpacked with care: whatever its entries claim, nothing leaves the folder."""

from __future__ import annotations

import os
import stat
import unicodedata
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZIP_STORED, BadZipFile, ZipFile, ZipInfo

from clutchwork.base import FMUError, quote
from clutchwork.base.regular import open_regular, reason

DESCRIPTION = "modelDescription.xml"
MOST_ENTRIES = 10_000
MOST_BYTES = 1_000_000_000
# bytes of all entries for one of the archive
MOST_PACKED = 200
# a description beyond it is none that people can have made
MOST_DESCRIPTION = 64_000_000
# packed bytes that are read; what unpacks to less than that has no use for more
MOST_ARCHIVE = 2 * MOST_BYTES
PIECE = 1 << 16
ENCRYPTED = 1


class Bytes:
    """Bytes that were unpacked of one archive, against their limits."""

    def __init__(self, packed: int) -> None:
        self.limit, self.count = MOST_PACKED * packed, 0

    def add(self, number: int) -> None:
        """Count; FMUError beyond a limit."""
        self.count += number
        if self.count > MOST_BYTES:
            raise FMUError(f"it unpacks to more than {MOST_BYTES} bytes")
        if self.count > self.limit:
            raise FMUError(f"it unpacks to more than {MOST_PACKED} times its size, which no FMU needs")


def description_of(path: Path) -> bytes:
    """The description in an FMU whose entries were all looked at; FMUError says what is wrong."""
    with _opened(path) as (archive, bytes_):
        try:
            item = archive.getinfo(DESCRIPTION)
        except KeyError:
            raise FMUError(f"it has no {DESCRIPTION}, so it is not an FMU") from None
        return b"".join(_content(archive, item, bytes_, MOST_DESCRIPTION))


def names_in(path: Path) -> list[str]:
    """The names of its files."""
    with _opened(path) as (archive, _):
        return [item.filename for item in archive.infolist() if not item.is_dir()]


def unpack(path: Path, folder: Path) -> None:
    """Unpack an FMU into an empty folder, which only its owner may enter; FMUError says what is wrong."""
    with _opened(path) as (archive, bytes_):
        for item in archive.infolist():
            target = folder.joinpath(*item.filename.rstrip("/").split("/"))
            if item.is_dir():
                target.mkdir(mode=0o700, parents=True, exist_ok=True)
                continue
            target.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            # what is there already is never written to
            number = os.open(target, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o700)
            with os.fdopen(number, "wb") as stream:
                for piece in _content(archive, item, bytes_, MOST_BYTES):
                    stream.write(piece)


def _content(archive: ZipFile, item: ZipInfo, bytes_: Bytes, most: int) -> Iterator[bytes]:
    """The content of an entry, counted as it comes, whatever its head says."""
    size = 0
    with archive.open(item) as stream:
        while piece := stream.read(PIECE):
            bytes_.add(len(piece))
            size += len(piece)
            if size > most:
                raise FMUError(f"its {item.filename} has more than {most} bytes")
            yield piece


@contextmanager
def _opened(path: Path) -> Iterator[tuple[ZipFile, Bytes]]:
    """An archive whose entries all have names and kinds that fit."""
    try:
        with open_regular(path, MOST_ARCHIVE) as stream:
            packed = os.fstat(stream.fileno()).st_size
            with ZipFile(stream) as archive:
                refuse_entries(archive.infolist())
                yield archive, Bytes(packed)
    except (BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, ValueError) as error:
        if isinstance(error, FMUError):
            raise
        raise FMUError(f"it is damaged or not an archive ({error})") from None
    except OSError as error:
        raise FMUError(f"it cannot be read: {reason(error)}") from None


def refuse_entries(items: list[ZipInfo]) -> None:
    """FMUError for entries that lead out of a folder, are links or devices, or appear twice."""
    if len(items) > MOST_ENTRIES:
        raise FMUError(f"it has {len(items)} entries, more than {MOST_ENTRIES}")
    files, folders = set[str](), set[str]()
    for item in items:
        fault = _fault(item)
        if fault:
            raise FMUError(f"its entry {quote(item.orig_filename)} {fault}")
        # file systems may take two such names for one
        name = unicodedata.normalize("NFC", item.filename.rstrip("/")).casefold()
        known = folders if item.is_dir() else files
        if name in known:
            raise FMUError(f"its entry {quote(item.filename)} is there twice")
        known.add(name)
    for name in files:
        parts = name.split("/")
        if name in folders or any("/".join(parts[:count]) in files for count in range(1, len(parts))):
            raise FMUError(f"its entry {quote(name)} is there twice, as a file and as a folder")


def _fault(item: ZipInfo) -> str:
    """Why an entry is not unpacked, empty where it is."""
    # as it stands in the archive: zipfile itself cuts names at a NUL and turns separators
    name = item.orig_filename
    parts = name.removesuffix("/").split("/")
    kind = stat.S_IFMT(item.external_attr >> 16)
    if name.startswith("/"):
        return "has an absolute path"
    if "\\" in name:
        return "has a backslash"
    if ":" in name:
        return "has a colon, as a drive has"
    if ".." in parts:
        return "leads out of its folder"
    if "" in parts or "." in parts or not name.isprintable():
        return "has no name that all file systems take"
    if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
        return "is a link" if stat.S_ISLNK(kind) else "is neither a file nor a folder"
    if item.flag_bits & ENCRYPTED:
        return "is encrypted"
    return "" if item.compress_type in (ZIP_STORED, ZIP_DEFLATED) else "is packed in a way that FMI does not know"
