"""MAT: one structure `run` with a field for each signal, and tables of their units and names."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from clutchwork.base import ClutchworkError
from clutchwork.base.extras import need
from clutchwork.exchange.content import Content, ExportedSignal
from clutchwork.exchange.safe_names import matlab

# fields beside those of the signals
OWN = ("time", "units", "names", "events", "info")
# a variable of a MAT file of version 5 has no more
MOST_BYTES = 2**31 - 2**20


class TooLargeError(ClutchworkError, ValueError):
    """More than a file of this format can hold."""


def write(content: Content, path: Path) -> None:
    """`run.time`, `run.engine_speed`, `run.units.engine_speed`, `run.names.engine_speed`, `run.events`, `run.info`."""
    scipy = need("scipy.io", "exchange", "a MAT file")
    fields = matlab(content.names, OWN)
    size = 8 * len(content.time) * (len(fields) + 1)
    if size > MOST_BYTES:
        remedy = "choose signals with names=, or a coarser raster with dt="
        raise TooLargeError(f"it would have {size} bytes, a MAT file has at most {MOST_BYTES}: {remedy}")
    data: dict[str, Any] = {"time": content.instants.values}
    data |= {fields[signal.name]: _values(signal) for signal in content.signals()}
    unit = content.made.unit
    data["units"] = {"time": unit("time")} | {fields[name]: unit(name) for name in content.names}
    data["names"] = {"time": "time"} | {fields[name]: name for name in content.names}
    data["events"] = {column.name: _cells(column) for column in content.event_columns()}
    data["info"] = {key: json.dumps(v) if isinstance(v, dict) else v for key, v in content.about().items()}
    with path.open("wb") as file:
        scipy.savemat(file, {"run": data}, long_field_names=True, oned_as="column", do_compression=True)


def _values(signal: ExportedSignal) -> Any:
    """Numbers as doubles, which is what MATLAB computes with; words as rows of characters of one length."""
    return signal.values if signal.is_text else signal.values.astype(float)


def _cells(column: ExportedSignal) -> Any:
    return np.array(column.values, dtype=object).reshape(-1, 1) if column.is_text else column.values
