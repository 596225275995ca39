"""Measurements from a file; the heads of the columns may say their units."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from clutchwork.base import dataclass, listed, near
from clutchwork.base.arrays import Array
from clutchwork.declare.quantity import QuantityError
from clutchwork.declare.units import parse
from clutchwork.fit.failure import FitError
from clutchwork.fit.measurement import Measurement, measurement
from clutchwork.signals.bases.column_file import names_of
from clutchwork.signals.bases.column_heads import meant, split
from clutchwork.signals.bases.measured import read_columns
from clutchwork.signals.bases.measured.formats import format_of
from clutchwork.signals.column import Column

CLOCK = "time"
UNITS = {"time": ("s",), "slip": ("rad/s", "m/s"), "torque": ("N m", "N"), "load": ("N m", "N"), "temperature": ("K",)}


@dataclass(frozen=True)
class TableHead:
    """A column by its name with its unit, and whether the unit is one of translation."""

    text: str
    translation: bool | None  # None: the head says no unit


def read(path: str | Path, columns: dict[str, str | float]) -> Measurement:
    """Samples from a CSV, MDF, MAT, Parquet or NetCDF file.

    Parameters: columns, the head of the column of time, slip, torque, load and, where it counts, temperature, with or
    without its unit; load and temperature may be numbers. A head such as `slip [rpm]` is converted to
    SI, one without a unit is SI.
    """
    known = _heads(Path(path))
    heads = {name: _head(name, wanted, known) for name, wanted in columns.items() if isinstance(wanted, str)}
    domains = {head.translation for head in heads.values()} - {None}
    if len(domains) > 1:
        found = ", ".join(repr(head.text) for head in heads.values())
        raise FitError(
            "columns", f"mix rotation and translation: {found}", "give all in rad/s and N m, or in m/s and N"
        )
    tables = {name: _table(path, head, heads["time"]) for name, head in heads.items() if name != "time"}
    time = tables["torque"][:, 0]
    for name, samples in tables.items():
        if not np.array_equal(samples[:, 0], time):
            remedy = "give columns that were recorded together, or put them on one raster"
            raise FitError(name, "has other times than the torque", remedy)
    rows = {name: samples[:, 1] for name, samples in tables.items()}
    load, temperature = (rows.get(name, columns.get(name)) for name in ("load", "temperature"))
    slip, torque = rows["slip"], rows["torque"]
    return measurement(time, slip, torque, load, temperature=temperature, translation=domains == {True})


def _heads(path: Path) -> list[str]:
    """The heads of all columns, with their units; other defects show when the columns are read."""
    try:
        if not format_of(path):
            return names_of(path)
        called = [(name, one.unit) for one in read_columns(path) for name in (one.name, *one.aliases)]
        # times of a group of channels are no channel
        return [CLOCK, *(f"{name} [{unit}]" if unit else name for name, unit in called if name != CLOCK)]
    except (OSError, ValueError):
        return []


def _head(name: str, wanted: str, known: list[str]) -> TableHead:
    """The head that is meant; that of a file that cannot be read stays, so that reading it says why."""
    found = meant(wanted, known)
    if not found:
        if not known:
            return TableHead(wanted, None)
        hint = near(wanted, known) or near(split(wanted)[0], [split(head)[0] for head in known])
        remedy = f"the columns are {listed(known)}{hint}"
        raise FitError(name, f"has no column {wanted!r}", remedy)
    head, units = found[0], UNITS[name]
    try:
        head.scale(units)
    except QuantityError as bad:
        raise FitError(name, f"column {head.text!r} {bad.message}", bad.remedy) from None
    # a name with a unit gives it to a head without
    text = wanted if head.unit and not split(head.text)[1] else head.text
    if not head.unit or name in ("time", "temperature"):
        return TableHead(text, None)
    return TableHead(text, parse(head.unit).powers != parse(units[0]).powers)


def _table(path: str | Path, head: TableHead, time: TableHead) -> Array:
    """Times and values of a column, a row each."""
    return np.array(Column(str(path), head.text, time=time.text).points)
