"""Parquet, as pandas, pyarrow and others write it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

from clutchwork.base.extras import need
from clutchwork.signals.bases.measured.series import Array, ColumnOf, Series, numbers, table


@contextmanager
def opened(path: Path) -> Iterator[list[Series]]:
    """The columns of a file."""
    need("pyarrow", "exchange", "a Parquet file")
    parquet = need("pyarrow.parquet", "exchange", "a Parquet file")
    with parquet.ParquetFile(str(path)) as file:
        schema = file.schema_arrow
        units = _units(schema.metadata or {})
        columns: dict[str, ColumnOf] = {}
        for field in schema:
            unit = (field.metadata or {}).get(b"unit", b"").decode() or units.get(field.name, "")
            columns[field.name] = (
                unit,
                file.metadata.num_rows,
                _is_text(field.type),
                partial(_values, file, field.name),
            )
        yield table(columns)


def _units(metadata: Mapping[bytes, bytes]) -> dict[str, str]:
    """What the file says as a whole, as `attrs` of pandas."""
    attributes = json.loads(metadata.get(b"PANDAS_ATTRS", b"{}"))
    told = attributes.get("units", {}) if isinstance(attributes, dict) else {}
    return {str(name): str(unit) for name, unit in told.items()} if isinstance(told, dict) else {}


def _is_text(kind: Any) -> bool:
    types = need("pyarrow.types", "exchange")
    return not (types.is_floating(kind) or types.is_integer(kind) or types.is_boolean(kind) or types.is_decimal(kind))


def _values(file: Any, name: str) -> Array:
    return numbers(file.read(columns=[name]).column(name).to_numpy())
