"""Tables in memory: pandas and xarray."""

from __future__ import annotations

from typing import Any

from clutchwork.base.extras import need
from clutchwork.exchange.content import Content


def to_pandas(content: Content) -> Any:
    """DataFrame with the time as index; `frame.attrs["units"]` holds the units."""
    pandas = need("pandas", "tables", "a table")
    columns = {signal.name: signal.values for signal in content.signals()}
    frame = pandas.DataFrame(columns, index=pandas.Index(content.instants.values, name="time"))
    frame.attrs["units"] = {name: content.made.unit(name) for name in content.names}
    return frame


def to_xarray(content: Content) -> Any:
    """Dataset with the dimension time; every variable carries its unit."""
    xarray = need("xarray", "tables", "a Dataset")
    variables = {signal.name: ("time", signal.values, {"units": signal.unit}) for signal in content.signals()}
    time = content.instants
    return xarray.Dataset(variables, coords={"time": ("time", time.values, {"units": time.unit})})
