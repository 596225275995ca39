"""NetCDF 4: a variable for each signal over the dimension time, and one for each field of the events."""

from __future__ import annotations

import json
from pathlib import Path

from clutchwork.base.extras import need
from clutchwork.exchange.content import Content
from clutchwork.exchange.frames import to_xarray
from clutchwork.exchange.safe_names import without


def write(content: Content, path: Path) -> None:
    """Units as attributes; the name of a signal, which a variable cannot always have, is its `long_name`."""
    # what xarray writes with
    for module in ("h5py", "h5netcdf"):
        need(module, "exchange", "a NetCDF file")
    data = to_xarray(content)
    for name in content.names:
        data[name].attrs["long_name"] = name
    for column in content.event_columns():
        values = column.values.astype(object) if column.is_text else column.values
        data[f"event_{column.name}"] = ("event", values, {"units": column.unit} if column.unit else {})
    data.attrs = {
        key: value if isinstance(value, str | float) else json.dumps(value) for key, value in content.about().items()
    }
    # a slash would be a folder inside of the file
    data = data.rename({name: safe for name, safe in without(content.names, "/").items() if name != safe})
    texts = [name for name in data.variables if data[name].dtype.kind in "UO"]
    data.to_netcdf(path, engine="h5netcdf", encoding={name: {"dtype": str} for name in texts})
