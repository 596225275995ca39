"""The files of a data set: one for each chunk, there as a whole or not at all."""

from __future__ import annotations

import json
import os
import socket
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.extras import need
from clutchwork.base.writing import NEW, replaced

if TYPE_CHECKING:
    from clutchwork.sweeps.result import Sweep

DATA = "data"
NAME = "part-{:06d}.parquet"
# of the metadata of a file
OWN = "clutchwork"
TYPES = {"f": "double", "i": "int64", "u": "int64", "b": "bool"}


@dataclass(frozen=True)
class DataField:
    """A column of the data set."""

    name: str
    type: str  # as pyarrow calls it
    unit: str = ""  # of SI


class Written(NamedTuple):
    """What is known of a part beside its columns."""

    variants: int
    begun: float  # s, since 1970
    seconds: float  # of the worker
    worker: str  # machine and process
    missing: int  # values of functions that raised


def file_of(folder: Path, number: int) -> Path:
    """Where a part is."""
    return folder / DATA / NAME.format(number)


def columns_of(first: Sweep) -> tuple[DataField, ...]:
    """The columns that a result has."""
    units = first.column_units()
    found = [DataField("variant", "int64")]
    return (*found, *(DataField(name, _type(values), units.get(name, "")) for name, values in first.columns()))


def _type(values: Any) -> str:
    if values.dtype.kind == "O":
        # what functions gave; of none there is nothing to tell a word by
        words = any(isinstance(value, str) for value in values.tolist())
        return "string" if words else "double"
    return TYPES.get(values.dtype.kind, "string")


def write(folder: Path, number: int, columns: tuple[DataField, ...], found: Sweep, first: int, begun: float) -> Written:
    """Write the part of some variants; a file with its name is whole."""
    parquet = need("pyarrow.parquet", "study", "a study")
    made = Written(len(found), begun, time.time() - begun, worker(), len(found.problems))
    units = {one.name: one.unit for one in columns if one.unit}
    # the second where pandas looks for `attrs`
    words = {OWN: json.dumps(made._asdict()), "PANDAS_ATTRS": json.dumps({"units": units})}
    words |= {f"unit {name}": unit for name, unit in units.items()}
    table = _table(columns, found, first).replace_schema_metadata(words)
    with replaced(file_of(folder, number)) as new:
        parquet.write_table(table, str(new))
    return made


def _table(columns: tuple[DataField, ...], found: Sweep, first: int) -> Any:
    pyarrow = need("pyarrow", "study", "a study")
    given = {"variant": np.arange(first, first + len(found)), **dict(found.columns())}
    return pyarrow.table({one.name: _array(pyarrow, one, given[one.name]) for one in columns})


def _array(pyarrow: Any, column: DataField, values: Any) -> Any:
    kind = pyarrow.type_for_alias(column.type)
    if column.type == "string":
        return pyarrow.array([None if value is None else str(value) for value in values.tolist()], kind)
    if values.dtype.kind == "O":
        values = np.array([np.nan if value is None else value for value in values.tolist()], dtype=float)
    return pyarrow.array(values).cast(kind)


def worker() -> str:
    """The machine and the process that this is."""
    return f"{socket.gethostname()} {os.getpid()}"


def there(folder: Path, sizes: dict[int, int]) -> dict[int, Written]:
    """Parts that are there and whole, by number.

    Parameters: sizes, how many variants each part has.
    """
    found = dict[int, Written]()
    for path in sorted((folder / DATA).glob("part-*.parquet")):
        with suppress(ValueError):
            number = int(path.stem.partition("-")[2])
            made = _known(path)
            if made is not None and made.variants == sizes.get(number):
                found[number] = made
    return found


def _known(path: Path) -> Written | None:
    """What a part says of itself; nothing where it is damaged."""
    pyarrow, parquet = need("pyarrow", "study", "a study"), need("pyarrow.parquet", "study")
    try:
        about = parquet.read_metadata(str(path))
        made = Written(**json.loads(about.metadata[OWN.encode()]))
    except (pyarrow.ArrowException, OSError, KeyError, TypeError, ValueError):
        return None
    return made if about.num_rows == made.variants else None


def without_leftovers(folder: Path) -> None:
    """Remove files of workers that died while they wrote."""
    for path in (folder / DATA).glob(f".*{NEW}*"):
        path.unlink(missing_ok=True)
