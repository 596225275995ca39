"""Results for other programs: one file for each format, each through the library of that format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import ClutchworkError, near, quote
from clutchwork.base.paths import fitting
from clutchwork.base.writing import replaced
from clutchwork.exchange import content, csv_table, mat, mdf, netcdf, parquet

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

_WRITERS: dict[str, Callable[[content.Content, Path], None]] = {
    "csv": csv_table.write,
    "parquet": parquet.write,
    "mdf": mdf.write,
    "mat": mat.write,
    "netcdf": netcdf.write,
}


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
    example = next(ending for ending, one in ENDINGS.items() if not form or one == form)
    path = fitting(f"run.to_{form}" if form else "run.write", path, f"run{example}")
    found = _format(path, form)
    chosen = content.content(run, names, dt, times, units)
    with replaced(path) as new:
        _WRITERS[found](chosen, new)


def _format(path: Path, form: str) -> str:
    """The format that the ending names; a file of a certain one may also have no ending."""
    found = ENDINGS.get(path.suffix.lower(), "" if path.suffix else form)
    if form and found != form:
        fits = " or ".join(ending for ending, one in ENDINGS.items() if one == form)
        raise EndingError(f"{quote(str(path))} ends in {quote(path.suffix)}, and to_{form} writes {fits}: rename it")
    if not found:
        if not path.suffix:
            raise EndingError(f"{quote(str(path))} has no ending; give one of {', '.join(ENDINGS)}, such as 'run.csv'")
        known = ", ".join(ENDINGS)
        raise EndingError(
            f"{quote(str(path))} ends in {quote(path.suffix)}{near(path.suffix, ENDINGS, f'formats are {known}')}"
        )
    return found
