"""Model files, TOML or JSON of the same shape: read with all mistakes at once, and written so that they read back.

    name = "two discs"
    [[shaft]]
    name = "engine"
    inertia = 0.2                       # SI, or a string with a unit: "2000 kg cm2"
    [[element]]
    name = "c1"
    type = "clutch"                     # kind of element, then its ports and parameters
    base = "engine"
    follower = "load"
    gain = 0.1
    pressure = {type = "column", path = "pressures.csv", column = "c1", unit = "bar"}
    friction = {type = "coulomb", static = 0.12, kinetic = 0.1}
    heat = "lining"
    [[thermal]]
    name = "lining"
    capacity = "2 kJ/K"
    [[ambient]]
    name = "air"
    temperature = 293.0
    [simulation]
    t_end = 2.0

Nothing in a model file is evaluated.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from math import inf
from pathlib import Path
from typing import Any

from clutchwork.base.errors import ModelError, ModelFileError, Problem, nearest
from clutchwork.base.paths import fitting
from clutchwork.base.quote import listed, quote, shortened
from clutchwork.base.regular import read_regular, reason
from clutchwork.base.toml_text import parsed
from clutchwork.base.writing import put
from clutchwork.declare.node import Domain
from clutchwork.declare.wording import words_of_files
from clutchwork.files.reader import FORMAT, ModelReader
from clutchwork.files.writer import Writer, toml
from clutchwork.model.findings import findings
from clutchwork.model.model import Model
from clutchwork.model.settings import plain_settings, settings_problems
from clutchwork.model.thermal import node_kind
from clutchwork.signals.bases.sheets import one_reading

# more belongs into CSV files
MOST_BYTES = 10_000_000
ENDINGS = (".toml", ".json")
# not suggested when a model file is missing
NO_MODELS = ("pyproject.toml", "package.json", "package-lock.json", "tsconfig.json", "Cargo.toml")
_HEAD = re.compile(r'\s*(\[\[?)\s*"?([A-Za-z_]+)"?\s*((?:\.\s*(?:"[^"]*"|[\w-]+)\s*)*)\]\]?\s*(#.*)?')
_KEY = re.compile(r'\s*"?([A-Za-z_][\w-]*)"?\s*[=.]')
_PATH = re.compile(r'(\w+)(?: number (\d+)| "(.*?)"(?= \(| and |$))?', re.DOTALL)


def load(path: str | Path, *, trust: bool = False) -> Model:
    """Read a model file; ModelError lists all its mistakes. Parameters: trust, whether it may have FMUs, which run."""
    path = Path(path)
    try:
        text = read_regular(path, MOST_BYTES).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        why = reason(error) if isinstance(error, OSError) else "it is not UTF-8 text"
        missing = isinstance(error, FileNotFoundError)
        remedy = _elsewhere(path) if missing else "give a TOML or JSON file in UTF-8"
        problem = Problem("file", "", "does not exist" if missing else f"cannot be read: {why}", remedy=remedy)
        raise ModelFileError([problem], str(path)) from None
    return _from_text(path, text.replace("\r\n", "\n"), trust=trust)


def _elsewhere(path: Path) -> str:
    """Where a file that is missing may be."""
    if not path.parent.is_dir():
        return f"check the path: there is no folder {quote(str(path.parent))}"
    files = [other for other in sorted(path.parent.iterdir()) if other.name not in NO_MODELS]
    others = {other.stem: other.name for other in files if other.suffix.lower() in ENDINGS}
    found = nearest(path.stem, others)
    if found:
        return f"did you mean {others[found]!r}?"
    if others:
        return f"check the path; in its folder: {listed([*others.values()][:5])}"
    return f"check the path, or write a model to start from: clutchwork new {path}"


def _from_text(path: Path, text: str, *, trust: bool) -> Model:
    if path.suffix.lower() not in ENDINGS:
        problem = Problem("file", "", "must end in .toml or .json", quote(path.name), "rename the file")
        raise ModelError([problem], str(path))
    with tolerable(str(path)):
        data = _parsed(path, text)
    return from_dict(data, path.parent, str(path), LineNumbers(text, path.suffix.lower()), trust=trust)


def _parsed(path: Path, text: str) -> Any:
    try:
        if path.suffix.lower() == ".json":
            return json.loads(text, object_pairs_hook=_once, parse_constant=_no_constant)
        return parsed(text)
    except ValueError as error:
        fault = f"is not valid {path.suffix[1:].upper()}: {shortened(str(error))}"
        raise ModelError([Problem("file", "", fault, remedy=_fix(str(error)))], str(path)) from None


@contextmanager
def tolerable(source: str) -> Iterator[None]:
    """Refuse data so deep that Python cannot follow it."""
    try:
        yield
    except RecursionError:
        remedy = "a model file needs four levels, and elements that follow each other's states no more than a few dozen"
        raise ModelError([Problem("file", "", "is nested too deeply", remedy=remedy)], source) from None


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    made: dict[str, Any] = {}
    for key, value in pairs:
        if key in made:
            raise ValueError(f"key {quote(key)} appears twice in one object")
        made[key] = value
    return made


def _no_constant(name: str) -> float:
    raise ValueError(f"{name} is not allowed in a model file")


def from_dict(
    data: Any, folder: str | Path = "", source: str = "", lines: LineNumbers | None = None, *, trust: bool = False
) -> Model:
    """A model from the content of a model file; CSV paths are relative to the folder."""
    reader = ModelReader(str(folder), trust)
    with tolerable(source), words_of_files(), one_reading():
        model = reader.model(data)
        problems = reader.problems + findings(model, reader.incomplete).problems
    if problems:
        placed = [lines.placed(problem, data) for problem in problems] if lines else problems
        # those without a line come last, sorting keeps the order of equals
        placed.sort(key=lambda problem: problem.line or inf)
        raise ModelError(placed, source or model.name)
    model.from_file = True
    return model


def save(model: Model, path: str | Path) -> None:
    """Write a model file, TOML or JSON by its ending; CSV files stay where they are."""
    path = fitting("d.save", path, "model.toml")
    data = to_dict(model, folder=path.parent)
    if path.suffix.lower() == ".json":
        text = json.dumps(data, indent=2, allow_nan=False, ensure_ascii=False) + "\n"
    elif path.suffix.lower() == ".toml":
        text = toml(data)
    else:
        problem = Problem("file", "", "must end in .toml or .json", quote(path.name), "rename the file")
        raise ModelError([problem], str(path))
    put(path, text)


def to_dict(model: Model, *, folder: str | Path | None = None, embed: bool = False) -> dict[str, Any]:
    """The content of a model file.

    Paths of CSV files become relative to the folder; with `embed` their values are written in their place.
    ModelError names what a model file cannot hold.
    """
    writer = Writer(None if folder is None else str(folder), embed)
    data: dict[str, Any] = {"format": FORMAT, "name": model.name}
    for key, domain in (("shaft", Domain.ROTATION), ("mass", Domain.TRANSLATION)):
        data[key] = [writer.node(node) for node in model.nodes if node.domain is domain]
    for key in ("thermal", "ambient"):
        data[key] = [writer.thermal(node) for node in model.thermal if node_kind(node) == key]
    elements = [writer.element(element) for element in model.elements]
    data["fmu"] = []
    if writer.fmus:
        # loaded where a model has one
        from clutchwork.files.fmus import table

        data["fmu"] = [table(fmu, name, writer.folder) for fmu, name in writer.fmus.items()]
    data["element"] = elements
    problems = [*writer.problems, *settings_problems(model.settings)]
    if problems:
        raise ModelError(problems, model.name)
    data["simulation"] = plain_settings(model.settings)
    return {key: value for key, value in data.items() if value not in ([], {})}


def _fix(words: str) -> str:
    """The place in a file that a parser complains of, to be fixed."""
    found = re.search(r"line (\d+),? column (\d+)", words)
    return f"fix line {found[1]}, column {found[2]}" if found else "fix the syntax"


class LineNumbers:
    """Where the tables of a file stand; nothing is known of JSON and of tables in one line."""

    def __init__(self, text: str, suffix: str) -> None:
        self._heads: dict[tuple[str, int], int] = {}
        self._keys: dict[tuple[str, int, str], int] = {}
        self._unread = text if suffix == ".toml" else ""

    def _read(self, text: str) -> None:
        counts: dict[str, int] = {}
        inside, table, below = False, ("file", 0), ""
        for number, line in enumerate(text.split("\n"), 1):
            head = None if inside else _HEAD.fullmatch(line)
            if head and head[3]:
                # a table inside of the last one: [element.shift.A]
                below = re.sub(r"[\s\"]", "", head[3])[1:] + "."
                table = (head[2], counts.get(head[2], 0))
                self._keys.setdefault((*table, below[:-1]), number)
            elif head:
                below = ""
                counts[head[2]] = counts.get(head[2], 0) + 1
                table = (head[2], counts[head[2]] if head[1] == "[[" else 0)
                self._heads.setdefault(table, number)
            elif not inside and (key := _KEY.match(line)):
                self._keys.setdefault((*table, below + key[1]), number)
            # a text over several lines may look like anything
            if (line.count('"""') + line.count("'''")) % 2:
                inside = not inside

    def placed(self, problem: Problem, data: Any) -> Problem:
        """A problem with its line, where that is known; most files have none, so they are read for the first one."""
        unread, self._unread = self._unread, ""
        self._read(unread)
        match = _PATH.match(problem.path)
        if match is None or not self._keys or not isinstance(data, Mapping):
            return problem
        kind, number = match[1], int(match[2] or 0)
        if match[3] is not None:
            entries = data.get(kind)
            listed = entries if isinstance(entries, list) else []
            names = [entry.get("name") if isinstance(entry, Mapping) else None for entry in listed]
            number = names.index(match[3]) + 1 if match[3] in names else -1
        words = re.split(r"[., ]", problem.quantity)
        key = words[0]
        ways = [".".join(words[:cut]) for cut in range(len(words), 0, -1)]
        line = next((self._keys[kind, number, way] for way in ways if (kind, number, way) in self._keys), 0)
        line = line or self._heads.get((kind, number), 0)
        if kind == "file":
            # a table with an unknown head
            line = line or self._heads.get((key, 1)) or self._heads.get((key, 0), 0)
        return replace(problem, line=line)
