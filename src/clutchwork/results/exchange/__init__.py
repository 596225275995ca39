"""Results for other programs: one file for each format, each through the library of that format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base.errors import ClutchworkError, UseError, near
from clutchwork.base.shown import shown
from clutchwork.results.exchange.content import Content, content

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded

# name of the format by ending of the file
ENDINGS = {
    ".csv": "csv",
    ".parquet": "parquet",
    ".mf4": "mdf",
    ".mat": "mat",
    ".nc": "netcdf",
}

_MODULES = {"csv": "csv_table", "parquet": "parquet", "mdf": "mdf", "mat": "mat", "netcdf": "netcdf"}


class EndingError(ClutchworkError, ValueError):
    """A file whose ending names no format."""


def write(
    run: Recorded,
    path: str | Path,
    names: Any = None,
    dt: float | None = None,
    *,
    times: Any = None,
    units: Mapping[str, str] | None = None,
    form: str = "",
) -> None:
    """Write signals of a run, in the format that the ending of the file names.

    Parameters: names, signals and wildcards, such as "c1.*", all by default; dt [s] or times [s], instants that are
    computed, not interpolated, all of the run by default; units, other ones than those of SI by signal; form,
    a format in place of that of the ending.
    """
    path = path_of(path, form or "write")
    make = _writer(form or _format(path))
    make(content(run, names, dt, times, units), path)


def path_of(path: str | Path, call: str) -> Path:
    """A path that is one; UseError where it is something else."""
    try:
        return Path(path)
    except TypeError:
        raise UseError(call, [f"path: {shown(path)} is not a path; give a string, such as 'run.mf4'"]) from None


def _format(path: Path) -> str:
    found = ENDINGS.get(path.suffix.lower())
    if found is None:
        known = ", ".join(ENDINGS)
        raise EndingError(
            f"{shown(str(path))} ends in {shown(path.suffix)}{near(path.suffix, ENDINGS, f'formats are {known}')}"
        )
    return found


def _writer(form: str) -> Callable[[Content, Path], None]:
    made: Callable[[Content, Path], None] = import_module(f"clutchwork.results.exchange.{_MODULES[form]}").write
    return made
