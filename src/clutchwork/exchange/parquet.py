"""Parquet: a column for each signal, with its unit; words as categories."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from clutchwork.base.extras import need
from clutchwork.exchange.content import Content, ExportedSignal


def write(content: Content, path: Path) -> None:
    """One row for each instant, the time first.

    Every field has its `unit`; the file says units and origin once more, where pandas looks for `attrs`.
    """
    pyarrow = need("pyarrow", "exchange", "a Parquet file")
    columns = [content.instants, *content.signals()]
    fields, arrays = [], []
    for column in columns:
        array = _array(pyarrow, column)
        fields.append(pyarrow.field(column.name, array.type, metadata={"unit": column.unit}))
        arrays.append(array)
    units = {column.name: column.unit for column in columns}
    words = {"PANDAS_ATTRS": json.dumps({"units": units, **content.about()}), "clutchwork": content.as_text()}
    words |= {f"unit {name}": unit for name, unit in units.items()}
    table = pyarrow.Table.from_arrays(arrays, schema=pyarrow.schema(fields, metadata=words))
    need("pyarrow.parquet", "exchange").write_table(table, str(path))


def _array(pyarrow: Any, column: ExportedSignal) -> Any:
    if not column.is_text:
        return pyarrow.array(column.values)
    codes, words = column.coded()
    return pyarrow.DictionaryArray.from_arrays(pyarrow.array(codes.astype("int8")), pyarrow.array(words, "string"))
