"""Trajectories for other programs."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base.extras import need
from clutchwork.results.units import converter

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded


def to_csv(run: Recorded, path: Path, names: tuple[str, ...]) -> None:
    """Columns with a head `name [unit]`; numbers keep all their digits."""
    table = [run.time, *(run[name] for name in names)]
    heads = ["time [s]", *(f"{name} [{run.units[name]}]" if run.units[name] else name for name in names)]
    cells = [column.tolist() for column in table]
    with path.open("w", encoding="utf-8", newline="") as file:
        # names may hold commas and quotes
        csv.writer(file, lineterminator="\n").writerow(heads)
        file.writelines(",".join(map(str, line)) + "\n" for line in zip(*cells, strict=True))


def to_pandas(run: Recorded, names: tuple[str, ...], units: Mapping[str, str] | None = None) -> Any:
    """DataFrame with the time as index; `frame.attrs["units"]` holds the units."""
    pandas, made = need("pandas", "tables", "a table"), converter(run, units)
    index = pandas.Index(made.time(run), name="time")
    frame = pandas.DataFrame({name: made.values(run, name) for name in names}, index=index)
    frame.attrs["units"] = {name: made.unit(name) for name in names}
    return frame


def to_xarray(run: Recorded, names: tuple[str, ...]) -> Any:
    """Dataset with the dimension time; every variable carries its unit."""
    xarray = need("xarray", "tables", "a Dataset")
    variables = {name: ("time", np.ascontiguousarray(run[name]), {"units": run.units[name]}) for name in names}
    return xarray.Dataset(variables, coords={"time": ("time", run.time, {"units": "s"})})
