"""NetCDF, as xarray and others write it: variables over one dimension."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from clutchwork.base.extras import need
from clutchwork.signals.bases.measured.series import Array, ColumnOf, Series, numbers, table


@contextmanager
def opened(path: Path) -> Iterator[list[Series]]:
    """The variables of a file that have one dimension."""
    xarray = need("xarray", "exchange", "a NetCDF file")
    with path.open("rb") as file:
        engine = "scipy" if file.read(3) == b"CDF" else "h5netcdf"
    need("scipy" if engine == "scipy" else "h5py", "exchange", "a NetCDF file")
    with xarray.open_dataset(str(path), engine=engine, decode_times=False) as data:
        lines = {str(name): one for name, one in data.variables.items() if len(one.dims) == 1}
        made = []
        for dimension in dict.fromkeys(one.dims[0] for one in lines.values()):
            beside = {name: _column(one) for name, one in lines.items() if one.dims == (dimension,)}
            made += table(beside, str(dimension))
        yield made


def _column(variable: Any) -> ColumnOf:
    is_text = variable.dtype.kind not in "iufb"
    return str(variable.attrs.get("units", "")), variable.size, is_text, partial(_values, variable)


def _values(variable: Any) -> Array:
    return numbers(variable.values)
