"""CSV files as spreadsheets write them where numbers have a decimal comma: semicolons between the cells."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

# more is no head of a table
LONGEST_HEAD = 1_000_000
_HEAD = bytes.maketrans(b";", b",")
_CELLS = bytes.maketrans(b";,", b",.")
# a point is one of thousands where there are decimal commas: such a cell is no number
_CELLS_OF_THOUSANDS = bytes.maketrans(b";,.", b",.'")


@contextmanager
def with_commas(file: BinaryIO) -> Iterator[BinaryIO]:
    """The file as it is where commas are between its cells, else the same with commas there, and decimal points.

    Semicolons separate where the first line has some, and neither commas nor quotes. The file is closed by its owner.
    """
    head = file.readline(LONGEST_HEAD)
    if b";" not in head or b"," in head or b'"' in head:
        file.seek(0)
        yield file
        return
    body = file.read()
    cells = _CELLS_OF_THOUSANDS if b"," in body else _CELLS
    yield io.BytesIO(head.translate(_HEAD) + body.translate(cells))
