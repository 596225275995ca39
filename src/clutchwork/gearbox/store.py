"""Gearbox files, TOML and JSON, those of the catalogue among them; shift tables from CSV."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from io import StringIO
from os import listdir
from pathlib import Path
from typing import Any

from clutchwork.base.errors import ModelError, ModelFileError, Problem, near
from clutchwork.base.quote import listed, quote, shortened
from clutchwork.base.regular import read_regular, reason
from clutchwork.base.toml_text import parsed
from clutchwork.gearbox.checks import problems
from clutchwork.gearbox.definition import Definition
from clutchwork.gearbox.reader import GearboxReader

CATALOGUE = Path(__file__).parent / "catalogue"
ENDINGS = (".toml", ".json")
# a gearbox takes a few kilobytes
MOST_BYTES = 1_000_000
_HEAD = re.compile(r'\s*\[\s*([\w-]+)\s*(?:\.\s*"?([^"\]]+?)"?\s*)?\]\s*(#.*)?')
_KEY = re.compile(r'\s*"?([^"=]+?)"?\s*=')


@cache
def names() -> tuple[str, ...]:
    """Names of the gearboxes of the catalogue."""
    found = [name.removesuffix(".toml") for name in listdir(CATALOGUE) if name.endswith(".toml")]  # noqa: PTH208, as fast as it gets
    return tuple(sorted(found))


def definition(source: str | Path) -> Definition:
    """A gearbox of the catalogue by its name, or that of a file; ModelError with all mistakes."""
    return _known(source) if isinstance(source, str) and source in names() else _of_file(source)


@cache
def _known(name: str) -> Definition:
    return _of_file(name)


def _of_file(source: str | Path) -> Definition:
    path = _path(source)
    text = _text(path)
    return from_data(_parsed(path, text), str(path), _lines(text) if path.suffix.lower() == ".toml" else {})


def content(source: str | Path) -> Any:
    """What stands in a gearbox file, not checked."""
    path = _path(source)
    return _parsed(path, _text(path))


def _path(source: str | Path) -> Path:
    """The file of a gearbox."""
    path = Path(source)
    if isinstance(source, str) and path.suffix.lower() not in ENDINGS:
        if source not in names():
            remedy = (
                "" if near(source, names()) else f"known gearboxes: {listed(names())}; a file ends in .toml or .json"
            )
            fault = f"is not in the catalogue{near(source, names())}"
            raise ModelFileError([Problem(f"gearbox {quote(source)}", "", fault, remedy=remedy)])
        return CATALOGUE / f"{source}.toml"
    return path


def _text(path: Path) -> str:
    try:
        return read_regular(path, MOST_BYTES).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        why = reason(error) if isinstance(error, OSError) else "it is not UTF-8 text"
        missing = isinstance(error, FileNotFoundError)
        fault = "does not exist" if missing else f"cannot be read: {why}"
        remedy = "check the path" if missing else "give a TOML, JSON or CSV file in UTF-8"
        raise ModelFileError([Problem("file", "", fault, remedy=remedy)], str(path)) from None


def _parsed(path: Path, text: str) -> Any:
    try:
        if path.suffix.lower() == ".json":
            return json.loads(text)
        return parsed(text)
    except RecursionError:
        deep = Problem("file", "", "is nested too deeply", remedy="a gearbox file needs four levels")
        raise ModelError([deep], str(path)) from None
    except ValueError as error:
        fault = f"is not valid {path.suffix[1:].upper()}: {shortened(str(error))}"
        raise ModelError([Problem("file", "", fault, remedy="fix the syntax")], str(path)) from None


def from_data(data: Any, source: str = "", lines: Mapping[tuple[str, str], int] | None = None) -> Definition:
    """A gearbox from the content of a file; ModelError with all mistakes."""
    reader = GearboxReader()
    made = reader.definition(data)
    found = reader.problems or (problems(made) if made else [])
    if made is None or found:
        placed = [_placed(problem, lines or {}) for problem in found]
        placed.sort(key=lambda problem: problem.line or MOST_BYTES)
        raise ModelError(placed, source or (made.name if made else "gearbox"))
    return made


def _lines(text: str) -> dict[tuple[str, str], int]:
    """Line of each (table, key) of a TOML file; that of a table itself has an empty key."""
    found: dict[tuple[str, str], int] = {}
    table = ""
    for number, line in enumerate(text.split("\n"), 1):
        if head := _HEAD.fullmatch(line):
            table = f'{head[1].removesuffix("s")} "{head[2]}"' if head[2] else head[1]
            found.setdefault((table, ""), number)
        elif key := _KEY.match(line):
            found.setdefault((table, key[1].strip()), number)
    return found


def _placed(problem: Problem, lines: Mapping[tuple[str, str], int]) -> Problem:
    """A problem with its line in the file."""
    what, _, name = problem.path.partition(' "')
    tables = {"gear": "gears", "element": "elements", "published": "published", "set": "sets", "machine": "machines"}
    places = [(problem.path, problem.quantity), (problem.path, "")]
    places += [(tables.get(what, ""), name.rstrip('"')), ("", problem.quantity), (problem.quantity, "")]
    return replace(problem, line=next((lines[place] for place in places if place in lines), 0))


MARKS = {"x", "1", "*", "o", "on", "yes", "true", "closed", "●", "•", "✓", "✔"}
BLANKS = {"", ".", "-", "0", "off", "no", "false", "open", "–", "—"}


def shift_table(text: str) -> tuple[dict[str, list[str]], dict[str, float], list[Problem]]:
    """Gears and published ratios of a shift table in CSV, and what is wrong with it.

    The first column names the gears, each further one an element, with a mark where it is closed; a column `ratio` has
    the published ratios. Separators are commas, semicolons or tabs; with the two last ones decimal commas are read.
    """
    rows = [[cell.strip() for cell in row] for row in _cells(text)]
    rows = [row for row in rows if any(row)]
    if len(rows) < 2 or len(rows[0]) < 2:
        fault = "has no table: a head with the names of the elements, then one row for each gear"
        return {}, {}, [Problem("file", "", fault, remedy="see the guide on gearboxes")]
    found: list[Problem] = []
    gears: dict[str, list[str]] = {}
    ratios: dict[str, float] = {}
    head = rows[0]
    for row in rows[1:]:
        gear, path = row[0], f'gear "{row[0]}"'
        if gear in gears:
            found.append(Problem(path, "", "appears twice", remedy="give each gear one row"))
        if len(row) != len(head):
            found.append(Problem(path, "", f"has {len(row)} cells for {len(head)} columns", remedy="complete the row"))
        gears[gear] = []
        for name, cell in zip(head[1:], row[1:], strict=False):
            if name.lower() in ("ratio", "i"):
                _read_ratio(gear, cell, ratios, found)
            elif cell.lower() in MARKS:
                gears[gear].append(name)
            elif cell.lower() not in BLANKS:
                remedy = "mark closed elements with x, leave others empty"
                found.append(Problem(path, name, "is not a mark", quote(cell), remedy))
    return gears, ratios, found


def _cells(text: str) -> list[list[str]]:
    head = text.lstrip("\ufeff").partition("\n")[0]
    separator = max(";\t,", key=head.count)
    return list(csv.reader(StringIO(text.lstrip("\ufeff")), delimiter=separator))


def _read_ratio(gear: str, cell: str, ratios: dict[str, float], found: list[Problem]) -> None:
    if cell.lower() in BLANKS:
        return
    try:
        ratios[gear] = float(cell.replace(",", ".").replace("−", "-"))
    except ValueError:
        found.append(Problem(f'gear "{gear}"', "ratio", "is not a number", quote(cell), "correct it or leave it empty"))


def with_shift_table(data: Mapping[str, Any], path: str | Path, text: str | None = None) -> Definition:
    """A gearbox from its data and a shift table in CSV, which stands for its gears and published ratios."""
    gears, ratios, found = shift_table(_text(Path(path)) if text is None else text)
    if found:
        raise ModelError(found, str(path))
    published: Mapping[str, float] = ratios or data.get("published", {})
    return from_data({**data, "gears": gears, "published": published}, str(path))


def toml(data: Mapping[str, Any]) -> str:
    """The content of a gearbox file as TOML text."""
    lines = [f"{key} = {_value(value)}" for key, value in data.items() if not isinstance(value, Mapping)]
    for key, table in data.items():
        if not isinstance(table, Mapping):
            continue
        if key == "sets":
            for name, entry in table.items():
                lines += ["", f"[sets.{_key(name)}]", *(f"{k} = {_value(v)}" for k, v in entry.items())]
        else:
            lines += ["", f"[{key}]", *(f"{_key(k)} = {_value(v)}" for k, v in table.items())]
    return "\n".join(lines) + "\n"


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name, ensure_ascii=False)


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + "}"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
