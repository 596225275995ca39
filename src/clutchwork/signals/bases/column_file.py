"""One column of a CSV file over its time column.

A file without quotes whose lines all have as many cells as the first one is read at once. Any other is read cell by
cell, which also finds the lines and columns of what is wrong. Messages give the place, never the content: a model may
name a file that does not belong to it.
"""

from __future__ import annotations

import csv
import io
from array import array
from collections.abc import Iterator
from itertools import chain
from math import inf, isclose, isfinite
from operator import itemgetter
from pathlib import Path
from typing import BinaryIO

import numpy as np

from clutchwork.base import FileError, dataclass, listed, near, quote
from clutchwork.base.arrays import Array
from clutchwork.base.regular import open_regular, reason
from clutchwork.declare.quantity import PLAIN, QuantityError
from clutchwork.declare.units import Scale
from clutchwork.signals.bases import sheets
from clutchwork.signals.bases.column_heads import ColumnHead, meant, split
from clutchwork.signals.bases.semicolons import with_commas
from clutchwork.signals.bases.sheets import NumericSheet

MOST_BYTES = 256_000_000
MOST_LINES = 2_000_000
LONGEST_LINE = 1_000_000
BLOCK = 1 << 20
# mistakes that are named, of all that a file has
MOST_FAULTS = 5
COMMA, NEWLINE, RETURN = 44, 10, 13


@dataclass(frozen=True)
class ColumnRequest:
    """A request to a file: its path as given, the names of its columns, and a factor on the values."""

    path: str
    time: str
    column: str
    scale: float = 1.0
    group: str = ""  # what the column stands in, where a file of another format has several of its name

    def error(self, quantity: str, message: str, remedy: str) -> FileError:
        """A single mistake."""
        return FileError([(quantity, f"{quote(self.path)} {message}", remedy)])


@dataclass(frozen=True)
class ColumnValues:
    """What was read: times and scaled values in SI, one row each, and the column that they are from."""

    table: Array
    head: ColumnHead


def read(where: str, wanted: ColumnRequest) -> ColumnValues:
    """The column of the file at a path; FileError names what is wrong with the file, up to a few mistakes."""
    sheet = sheets.known(where)
    made = _column(sheet, wanted) if sheet else None
    if made is not None:
        return made
    try:
        with open_regular(where, MOST_BYTES) as file, with_commas(file) as plain:
            return _read(plain, wanted, where)
    except FileNotFoundError:
        raise wanted.error("path", "does not exist", f"put the file into {_folder(where)}") from None
    except OSError as error:
        raise wanted.error("path", f"cannot be read: {reason(error)}", "give a CSV file") from None
    except (UnicodeDecodeError, csv.Error):
        raise wanted.error("path", "cannot be read: it is not UTF-8 text", "give a CSV file") from None


def _folder(where: str) -> str:
    """The folder in which a file is looked for, in full."""
    return quote(str(Path(where).absolute().parent))


def _scaled(table: Array, scales: tuple[Scale, Scale], wanted: ColumnRequest) -> Array:
    """Times and values in SI, all finite and so are the slopes between them."""
    with np.errstate(all="ignore"):
        made = table * [scale.factor for scale in scales]
        if scales[1].zero:
            made[:, 1] += scales[1].zero
        step = np.diff(made, axis=0)
        slopes = np.divide(step[:, 1], step[:, 0], out=np.zeros(len(step)), where=step[:, 0] > 0.0)
    if not np.all(np.isfinite(slopes)) or not np.all(np.isfinite(made)):
        raise wanted.error(
            "path", "has values that are too large, or change too fast", "remove times that nearly coincide"
        )
    return made


def _column(sheet: NumericSheet, wanted: ColumnRequest) -> ColumnValues | None:
    """A column of a file that was read before; None if its times need checking again."""
    time, column = _heads(sheet.header, wanted)
    places = [sheet.header.index(time.text), sheet.header.index(column.text)]
    if not sheet.is_plain(places[0]):
        return None
    made, scales = sheet.table[:, places], _scales(time, column, wanted)
    return ColumnValues(made if scales == (PLAIN, PLAIN) else _scaled(made, scales, wanted), column)


def _read(file: BinaryIO, wanted: ColumnRequest, where: str) -> ColumnValues:
    alike = _scan(file, wanted)
    size = file.tell()
    with as_text(file) as text:
        header, lines = _opened(text)
        if not header:
            raise wanted.error("path", "is empty", "give a header line and at least one row of numbers")
        sheet = sheets.keep(where, size, header, lines) if alike else None
        found = _column(sheet, wanted) if sheet else None
        if found is not None:
            return found
        header, lines = _opened(text)
        time, column = _heads(header, wanted)
        scales = _scales(time, column, wanted)
        places = header.index(time.text), header.index(column.text)
        made = _at_once(lines, places) if alike else None
        made = _by_cells(_opened(text)[1], header, places, wanted) if made is None else made
    return ColumnValues(_scaled(made, scales, wanted), column)


def as_text(file: BinaryIO) -> io.TextIOWrapper:
    """The characters of a file."""
    return io.TextIOWrapper(file, encoding="utf-8-sig", newline="")


def _opened(text: io.TextIOWrapper) -> tuple[list[str], Iterator[list[str]]]:
    """The names of the columns, and the lines behind them."""
    text.seek(0)
    lines = csv.reader(text)
    return [name.strip() for name in next(lines, [])], lines


def _scan(file: BinaryIO, wanted: ColumnRequest) -> bool:
    """Whether all lines are alike and without quotes; a file that is not a table of characters is refused."""
    alike, count, cells = True, 0, -1
    for block in _blocks(file, wanted):
        codes = np.frombuffer(block, np.uint8)
        ends = np.flatnonzero(codes == NEWLINE)
        starts = np.concatenate([[0], ends[:-1] + 1])
        count += len(ends)
        if b"\0" in block:
            raise wanted.error("path", "cannot be read: it is not text", "give a CSV file")
        if count > MOST_LINES + 1:
            raise wanted.error("path", f"has more than {MOST_LINES} lines", "give fewer samples")
        commas = np.add.reduceat((codes == COMMA).astype(np.intp), starts)
        cells = int(commas[0]) if cells < 0 else cells
        # a line without anything is skipped
        bare = (ends == starts) | ((ends == starts + 1) & (codes[starts] == RETURN))
        alike = alike and bool(np.all((commas == cells) | bare))
        # Python reads 1_0 as ten, a spreadsheet does not
        alike = (
            alike
            and b'"' not in block
            and b"_" not in block.partition(b"\n")[2]
            and block.count(b"\r") == block.count(b"\r\n")
        )
    return alike and count > 1


def _blocks(file: BinaryIO, wanted: ColumnRequest) -> Iterator[bytes]:
    """Stretches of whole lines, the last one closed where the file does not do so."""
    left = b""
    while block := file.read(BLOCK):
        whole, newline, rest = block.rpartition(b"\n")
        if newline:
            yield left + whole + newline
            left = rest
        else:
            left += rest
        if len(left) > LONGEST_LINE:
            raise wanted.error("path", f"has a line of more than {LONGEST_LINE} bytes", "give a CSV file")
    if left:
        yield left + b"\n"


def _heads(header: list[str], wanted: ColumnRequest) -> tuple[ColumnHead, ColumnHead]:
    """Heads of the time column and of the values."""
    found = meant(wanted.time, header), meant(wanted.column, header)
    names = (("time", wanted.time, found[0]), ("column", wanted.column, found[1]))
    faults = [_name_fault(header, *name, any(found), wanted) for name in names if len(name[2]) != 1]
    if faults:
        raise FileError(faults)
    return found[0][0], found[1][0]


def _name_fault(
    header: list[str], quantity: str, name: str, found: list[ColumnHead], asked: bool, wanted: ColumnRequest
) -> tuple[str, str, str]:
    path, texts = quote(wanted.path), list(dict.fromkeys(head.text for head in found))
    if len(texts) > 1:
        return quantity, f"{path} has {len(found)} columns {quote(name)}", f"name one of them: {listed(texts)}"
    if found:
        return quantity, f"{path} has {len(found)} columns {quote(name)}", "give every column a different name"
    remedy = "the first line names the columns, with commas between them"
    if asked:
        hint = near(name, header) or near(split(name)[0], [split(head)[0] for head in header])
        remedy = f"the columns are {listed(header)}{hint}"
    return quantity, f"{path} has no column {quote(name)}", remedy


def _scales(time: ColumnHead, column: ColumnHead, wanted: ColumnRequest) -> tuple[Scale, Scale]:
    """What puts times and values into SI, by the units of their heads; a scale that repeats the unit is refused."""
    scales, faults = [], []
    for quantity, head, units in (("time", time, ("s",)), ("column", column, ())):
        try:
            scales.append(head.scale(units))
        except QuantityError as bad:
            fault = f"column {quote(head.text)} of {quote(wanted.path)} {bad.message}"
            faults.append((quantity, fault, bad.remedy))
    if faults:
        raise FileError(faults)
    factor, zero = scales[1]
    if factor != 1.0 and isclose(factor, wanted.scale):
        fault = f"repeats the unit of column {quote(column.text)} of {quote(wanted.path)}"
        raise FileError([("scale", fault, "remove scale: the values are already converted by the unit of the column")])
    return scales[0], Scale(factor * wanted.scale, zero * wanted.scale)


def in_si(table: Array, heads: tuple[ColumnHead, ColumnHead], wanted: ColumnRequest) -> ColumnValues:
    """Times and values of another format, by the units of their heads."""
    return ColumnValues(_scaled(table, _scales(*heads, wanted), wanted), heads[1])


def names_of(path: Path) -> list[str]:
    """The first line of a file; None if it cannot be read: other defects show when its columns are read."""
    try:
        with open_regular(path, MOST_BYTES) as file, with_commas(file) as plain, as_text(plain) as text:
            return _opened(text)[0]
    except (OSError, UnicodeDecodeError, csv.Error):
        return []


def _at_once(lines: Iterator[list[str]], places: tuple[int, int]) -> Array | None:
    """All rows of a file whose lines are alike; None where anything is wrong with them."""
    rows = map(itemgetter(*places), filter(None, lines))
    try:
        table = np.fromiter(map(float, chain.from_iterable(rows)), float).reshape(-1, 2)
    except ValueError:
        return None
    sound = len(table) and np.all(np.isfinite(table)) and np.all(np.diff(table[:, 0]) >= 0.0)
    return table if sound else None


def _by_cells(lines: Iterator[list[str]], header: list[str], places: tuple[int, int], wanted: ColumnRequest) -> Array:
    """Rows one after another, with the line of each; the first few mistakes are named."""
    numbers, kept, faults = array("d"), array("q"), list[tuple[str, str, str]]()
    for line in lines:
        pair = _pair(line, len(header), places)
        number: int = lines.line_num  # type: ignore[attr-defined]
        if pair is not None:
            numbers.extend(pair)
            kept.append(number)
            continue
        faults += _line_faults(line, header, places, f"line {number} of {quote(wanted.path)}")
        if len(faults) >= MOST_FAULTS:
            break
    table = np.array(numbers).reshape(-1, 2)
    if not faults and not len(table):
        raise wanted.error("path", "has no row of numbers", "give at least one row below the header")
    for place in np.flatnonzero(np.diff(table[:, 0]) < 0.0)[:MOST_FAULTS] if not faults else ():
        where = f"line {kept[place + 1]} of {quote(wanted.path)}"
        faults.append(("time", f"{where}: its time is before that of line {kept[place]}", "sort the file by time"))
    if faults:
        raise FileError(faults[:MOST_FAULTS])
    return table


def _pair(line: list[str], width: int, places: tuple[int, int]) -> tuple[float, float] | None:
    """Time and value of a line; None where anything is wrong with it, or nothing is written."""
    try:
        time, value = (line[place] for place in places)
        # Python reads 1_0 as ten, a spreadsheet does not
        pair = (float(time), float(value)) if "_" not in time and "_" not in value else (inf, inf)
    except (ValueError, IndexError):
        return None
    sound = isfinite(pair[0]) and isfinite(pair[1]) and (len(line) <= width or not any(map(str.strip, line[width:])))
    return pair if sound else None


def _line_faults(
    line: list[str], header: list[str], places: tuple[int, int], where: str
) -> Iterator[tuple[str, str, str]]:
    """What is wrong with a line; one that is empty, as at the end of many files, carries nothing."""
    cells = [cell.strip() for cell in line]
    if not any(cells):
        return
    if any(cells[len(header) :]):
        message = f"{where} has {len(line)} cells, the first line names {len(header)} columns"
        yield "path", message, "give one cell per column; a decimal comma splits a number in two"
    for place, quantity in zip(places, ("time", "column"), strict=True):
        cell = cells[place] if place < len(cells) else ""
        if _pair([cell], 1, (0, 0)) is None:
            fault = "is not a finite number" if cell else "is empty, not a finite number"
            message = f"{where}: the cell in column {quote(header[place])} {fault}"
            yield quantity, message, "write a number with a decimal point"
