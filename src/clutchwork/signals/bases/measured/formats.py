"""Which format a file has, by its first bytes or else by its ending, and what opens it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

from clutchwork.base import FileError, quote
from clutchwork.base.regular import open_regular
from clutchwork.signals.bases.measured.series import Series

# other programs write large files, of which a part is read
MOST_BYTES = 1 << 40
ENDINGS = {".mf4": "mdf", ".mdf": "mdf", ".mat": "mat", ".parquet": "parquet", ".nc": "netcdf"}
WORDS = {"mdf": "an MDF file", "mat": "a MAT file", "parquet": "a Parquet file", "netcdf": "a NetCDF file"}
_HEADS = ((b"MDF ", "mdf"), (b"UnFinMF", "mdf"), (b"MATLAB ", "mat"), (b"PAR1", "parquet"), (b"CDF", "netcdf"))
_HDF = b"\x89HDF"


def format_of(path: Path) -> str:
    """Name of the format, empty for text; OSError where the file cannot be read."""
    with open_regular(path, MOST_BYTES) as file:
        head = file.read(16)
    named = ENDINGS.get(path.suffix.lower(), "")
    if head.startswith(_HDF):
        return named if named in ("mat", "netcdf") else "netcdf"
    return next((form for start, form in _HEADS if head.startswith(start)), named)


def _refuse_others(path: Path, form: str) -> None:
    """ValueError where a file does not begin as one of its format does; the first versions of MAT had no head."""
    with path.open("rb") as file:
        head = file.read(16)
    starts = [start for start, name in _HEADS if name == form] + ([_HDF] if form in ("mat", "netcdf") else [])
    if form != "mat" and not any(head.startswith(start) for start in starts):
        raise ValueError(form)


@contextmanager
def opened(path: Path, form: str, given: str) -> Iterator[list[Series]]:
    """The series of a file while it is open; FileError where it is damaged, or no file of that format.

    Parameters: given, the path in the words of the model.
    """
    # the build imports signals and has no numpy
    from clutchwork.signals.bases.measured import mat_file, mdf_file, netcdf_file, parquet_file

    readers = {"mdf": mdf_file, "mat": mat_file, "parquet": parquet_file, "netcdf": netcdf_file}
    open_: Callable[[Path], AbstractContextManager[list[Series]]] = readers[form].opened
    try:
        _refuse_others(path, form)
        with open_(path) as found:
            yield found
    except (FileError, ImportError, KeyboardInterrupt, MemoryError):
        raise
    # libraries raise whatever they stumble over, in words that tell what is in the file
    except Exception:
        message = f"{quote(given)} cannot be read as {WORDS[form]}: it is damaged, or has another format"
        raise FileError([("path", message, "write the file again, or give a CSV file")]) from None
