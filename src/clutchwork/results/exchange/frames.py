"""Tables in memory: pandas and xarray."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from clutchwork.base.extras import need
from clutchwork.results.exchange.content import Content
from clutchwork.results.units import converter


def to_pandas(content: Content, units: Mapping[str, str] | None = None) -> Any:
    """DataFrame with the time as index; `frame.attrs["units"]` holds the units."""
    pandas, made = need("pandas", "tables", "a table"), converter(content.run, units)
    columns = {signal.name: made.put(signal.values, signal.name) for signal in content.signals()}
    frame = pandas.DataFrame(columns, index=pandas.Index(made.put(content.time, "time"), name="time"))
    frame.attrs["units"] = {name: made.unit(name) for name in content.names}
    return frame


def to_xarray(content: Content) -> Any:
    """Dataset with the dimension time; every variable carries its unit."""
    xarray = need("xarray", "tables", "a Dataset")
    variables = {signal.name: ("time", signal.values, {"units": signal.unit}) for signal in content.signals()}
    return xarray.Dataset(variables, coords={"time": ("time", content.time, {"units": "s"})})
