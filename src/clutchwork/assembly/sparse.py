"""Matrices by rows without their zeros, as a System holds them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from clutchwork.assembly.records import Array
from clutchwork.declare.rational import Row


def sparse(name: str, rows: Sequence[Row], places: Mapping[int, int]) -> dict[str, Any]:
    """The arrays of a matrix of that name; `places`: the column of each number that stands in a row."""
    ends, columns, values = list[int](), list[int](), list[float]()
    for row in rows:
        for place, number in sorted((places[number], number) for number in row if number in places):
            # the quotient of two whole numbers is rounded once
            value = row[number].numerator / row[number].denominator
            if value:
                columns.append(place)
                values.append(value)
        ends.append(len(columns))
    return {f"{name}_end": ends, f"{name}_column": columns, f"{name}_value": values}


def supports(arrays: Mapping[str, Array], name: str) -> list[list[int]]:
    """Columns in which each row has a number."""
    ends, columns = arrays[f"{name}_end"].tolist(), arrays[f"{name}_column"].tolist()
    return [columns[start:end] for start, end in zip([0, *ends], ends, strict=False)]


def entries(arrays: Mapping[str, Array], name: str) -> list[dict[int, float]]:
    """Each row as its numbers by column."""
    ends, values = arrays[f"{name}_end"].tolist(), arrays[f"{name}_value"].tolist()
    starts = [0, *ends]
    return [
        dict(zip(columns, values[start:end], strict=True))
        for columns, start, end in zip(supports(arrays, name), starts, ends, strict=False)
    ]


def dense(arrays: Mapping[str, Array], name: str) -> Array:
    """The whole matrix, zeros included."""
    ends, speeds = arrays[f"{name}_end"], len(arrays["massless"])
    made = np.zeros((len(ends), speeds))
    rows = np.repeat(np.arange(len(ends)), np.diff(ends, prepend=0))
    made[rows, arrays[f"{name}_column"]] = arrays[f"{name}_value"]
    made.flags.writeable = False
    return made
