"""Measurements from a CSV file; the heads of the columns may say their units."""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from clutchwork.column_file import MOST_BYTES
from clutchwork.errors import near
from clutchwork.files import open_regular
from clutchwork.fit.failure import FitError
from clutchwork.fit.measurement import Measurement, measurement
from clutchwork.quantity import QuantityError, factor_to_si
from clutchwork.shown import listed
from clutchwork.signals.column import Column
from clutchwork.units import parse

Array = NDArray[np.float64]

UNITS = {"time": ("s",), "slip": ("rad/s", "m/s"), "torque": ("N m", "N"), "load": ("N m", "N"), "temperature": ("K",)}
_HEAD = re.compile(r"(.*?)\s*\[(.*)\]")


@dataclass(frozen=True)
class Head:
    """Head of a column: its whole text in the file, factor to SI, and whether the unit is one of translation."""

    text: str
    factor: float
    translation: bool | None  # None: the head says no unit


def read(path: str | Path, columns: dict[str, str | float]) -> Measurement:
    """Samples from a CSV file.

    Parameters: columns, the head of the column of time, slip, torque, load and, where it counts, temperature, with or
    without its unit; load and temperature may be numbers. A head such as `slip [rpm]` is converted to
    SI, one without unit is SI.
    """
    known = _heads(Path(path))
    heads = {name: _head(name, wanted, known) for name, wanted in columns.items() if isinstance(wanted, str)}
    domains = {head.translation for head in heads.values()} - {None}
    if len(domains) > 1:
        found = ", ".join(repr(head.text) for head in heads.values())
        raise FitError(
            "columns", f"mix rotation and translation: {found}", "give all in rad/s and N m, or in m/s and N"
        )
    rows = {name: _column(path, head, heads["time"]) for name, head in heads.items() if name != "time"}
    time = _column(path, heads["time"], heads["time"])
    load, temperature = (rows.get(name, columns.get(name)) for name in ("load", "temperature"))
    slip, torque = rows["slip"], rows["torque"]
    return measurement(time, slip, torque, load, temperature=temperature, translation=domains == {True})


def _heads(path: Path) -> list[str]:
    """The first line of the file; what else is wrong with it, reading the columns tells."""
    try:
        with open_regular(path, MOST_BYTES) as file, io.TextIOWrapper(file, "utf-8-sig", newline="") as stream:
            return [name.strip() for name in next(csv.reader(stream), [])]
    except (OSError, UnicodeDecodeError, csv.Error):
        return []


def _head(name: str, wanted: str, known: list[str]) -> Head:
    """The head that is meant; a name that is not found stays, so that reading it tells the near ones."""
    base, unit = _split(wanted)
    same = [head for head in known if head == wanted]
    alike = [head for head in known if _split(head)[0] == base and "" in (unit, _split(head)[1])]
    text = (same or alike or [wanted])[0]
    unit = _split(text)[1] or unit
    if not same and not alike:
        if known:
            hint = near(wanted, known) or near(base, [_split(head)[0] for head in known])
            remedy = f"the columns are {listed(known)}{hint}"
            if len(known) == 1 and ";" in known[0]:
                remedy = "separate the columns with commas, not with semicolons"
            raise FitError(name, f"has no column {wanted!r}", remedy)
        return Head(text, 1.0, None)
    if not unit:
        return Head(text, 1.0, None)
    wanted_unit, *others = UNITS[name]
    try:
        factor = factor_to_si(unit, wanted_unit, tuple(others), text)
    except QuantityError as bad:
        raise FitError(name, f"column {text!r} {bad.message}", bad.remedy) from None
    domain = None if name in ("time", "temperature") else parse(unit).powers != parse(wanted_unit).powers
    return Head(text, factor, domain)


def _split(head: str) -> tuple[str, str]:
    """Name and unit of a head such as `slip [rad/s]`."""
    match = _HEAD.fullmatch(head)
    return (match[1], match[2]) if match else (head, "")


def _column(path: str | Path, head: Head, time: Head) -> Array:
    points = np.array(Column(str(path), head.text, time=time.text).points)
    return head.factor * points[:, 1]
