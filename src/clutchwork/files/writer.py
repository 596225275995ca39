"""From a driveline to the plain data of a model file, and to TOML text."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import MISSING
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import Problem
from clutchwork.declare.node import DIRECT, is_reference
from clutchwork.declare.schema import Spec, specs
from clutchwork.declare.wording import path_of
from clutchwork.files.references import REFERENCES
from clutchwork.files.values import element_kinds, is_path
from clutchwork.fmu_import.output import Output
from clutchwork.model.numbers import At
from clutchwork.model.problems import NODE_FIELDS
from clutchwork.model.thermal import NODE_FIELDS as NODE_KINDS
from clutchwork.model.thermal import node_kind
from clutchwork.signals.column import Column
from clutchwork.signals.sampled import Sampled

if TYPE_CHECKING:
    from clutchwork.declare.node import Component, Node, ThermalNode
    from clutchwork.fmu_import.fmu import FMU


class Writer:
    """Turns elements into plain data."""

    def __init__(self, folder: str | None, embed: bool) -> None:
        self.folder, self.embed = folder, embed
        self.problems: list[Problem] = []
        self.fmus: dict[FMU, str] = {}  # of other people, by their names in the file

    def node(self, node: Node) -> dict[str, Any]:
        """A shaft or a mass; what has its default value is left out."""
        names = NODE_FIELDS[node.domain]
        values = dict(zip(names, (node.inertia, node.speed, node.angle), strict=True))
        given = {
            key: float(value)
            for key, value in values.items()
            if value is not None and (value or key in ("speed", "position"))
        }
        return {"name": node.name, **given}

    def thermal(self, node: ThermalNode) -> dict[str, Any]:
        """A thermal mass or an ambient."""
        fields_ = NODE_KINDS[node_kind(node)]
        at = At(f'{node_kind(node)} "{node.name}"', "")
        set_ = {key: spec for key, spec in fields_.items() if getattr(node, key) is not None}
        given = {key: self._value(getattr(node, key), spec, at.inner(key)) for key, spec in set_.items()}
        return {"name": node.name, **given}

    def element(self, element: Component) -> dict[str, Any]:
        """An element with its type, ports and parameters."""
        kind = type(element).kind
        return {"name": element.name, "type": kind, **self._fields(element, path_of(element))}

    def _fields(self, thing: Any, path: str) -> dict[str, Any]:
        made = {}
        for item, spec in specs(type(thing)):
            value = getattr(thing, item.name)
            if value is not None and (item.default is MISSING or value != item.default):
                made[item.name] = self._of(thing, item.name, value, spec, At(path, item.name))
        return made

    def _of(self, thing: Any, name: str, value: Any, spec: Spec, at: At) -> Any:
        """The value of a field: a table that a composite reads, or any other."""
        if spec.what == "named":
            return {key: float(number) for key, number in value.items()}
        if spec.what == "elements":
            kinds = thing.entry_kinds(vars(thing))
            return {key: self._table(table, kinds.get(f"{name}.{key}"), at) for key, table in value.items()}
        if spec.what == "data":
            if isinstance(value, str) and not self.embed:
                return self._relative(Path(value)) if is_path(value) else value
            return thing.content(name)
        if name in _units_of_numbers(thing):
            return f"{float(value)!r} {spec.unit}"
        return self._value(value, spec, at)

    def _table(self, table: Mapping[str, Any], kind: str | None, at: At) -> dict[str, Any]:
        """An element of a composite."""
        known = {item.name: spec for item, spec in specs(element_kinds()[table.get("type", kind)])}
        return {
            key: value if key == "type" else self._value(value, known[key], at.inner(key))
            for key, value in table.items()
            if value is not None
        }

    def _value(self, value: Any, spec: Spec, at: At) -> Any:
        if spec.what in ("port", "thermal"):
            return value.name
        if is_reference(value):
            return _reference(value)
        if spec.what == "function":
            message = "is a Python function, which a model file cannot hold"
            self.problems.append(at.problem(message, remedy="give a table, or keep the model in Python"))
            return None
        if spec.what == "formula" and isinstance(value, Mapping):
            return dict(value)
        if spec.what == "curve" and not isinstance(value, Real):
            return [[float(x), float(y)] for x, y in value]
        if spec.what == "numbers":
            return [list(map(float, row)) if hasattr(row, "__len__") else float(row) for row in value]
        if isinstance(value, Column) and self.embed:
            return {"type": "table", "points": [list(pair) for pair in value.points]}
        if isinstance(value, Sampled) and isinstance(value.function, Output):
            return {"fmu": self._named(value.function.fmu), "output": value.function.name}
        if hasattr(value, "__dataclass_fields__"):
            fields_ = self._fields(value, at.path)
            if isinstance(value, Column):
                fields_["path"] = self._relative(Path(value.folder, value.path))
            return {"type": value.kind, **fields_}
        return value if isinstance(value, str | bool | int) else float(value)

    def _named(self, fmu: FMU) -> str:
        """The name of an FMU, another one where two have the same."""
        if fmu not in self.fmus:
            taken, number = set(self.fmus.values()), 1
            while (name := fmu.name if number == 1 else f"{fmu.name} {number}") in taken:
                number += 1
            self.fmus[fmu] = name
        return self.fmus[fmu]

    def _relative(self, full: Path) -> str:
        if self.folder is None or full.is_absolute():
            return str(full)
        return Path(os.path.relpath(full, self.folder)).as_posix()


def _units_of_numbers(thing: Any) -> tuple[str, ...]:
    """Names of the numbers of a formula that have a unit, which stands nowhere but beside them."""
    return tuple(one.name for one in getattr(thing, "numbers", ()) if one.unit != "1")


def _reference(value: Any) -> Any:
    """An input that another component gives: its name, or a table."""
    if isinstance(value, tuple):
        return {"of": value[0].name, "state": value[1]}
    if isinstance(value, DIRECT):
        kind = next(name for name, cls in REFERENCES.items() if isinstance(value, cls))
        return {"type": kind, "of": value.of.name}
    return value.name


def toml(data: Mapping[str, Any]) -> str:
    """A model as TOML text."""
    lines = [f"{key} = {toml_value(value)}" for key, value in data.items() if not isinstance(value, list | Mapping)]
    for key, value in data.items():
        for table in value if isinstance(value, list) else [value] if isinstance(value, Mapping) else []:
            lines += ["", f"[[{key}]]" if isinstance(value, list) else f"[{key}]"]
            lines += [f"{_key(name)} = {toml_value(entry)}" for name, entry in table.items() if not _deep(entry)]
            for name, entry in table.items():
                lines += _below(f"{key}.{_key(name)}", entry) if _deep(entry) else []
    return "\n".join(lines) + "\n"


def _deep(value: Any) -> bool:
    """Whether a table holds tables, which are easier to read below heads of their own."""
    return isinstance(value, Mapping) and any(isinstance(entry, Mapping) for entry in value.values())


def _below(head: str, table: Mapping[str, Any]) -> Iterator[str]:
    """The tables of an element below their heads."""
    plain = {name: entry for name, entry in table.items() if not isinstance(entry, Mapping)}
    if plain:
        yield from ("", f"[{head}]", *(f"{_key(name)} = {toml_value(entry)}" for name, entry in plain.items()))
    for name, entry in table.items():
        if name not in plain:
            yield from ("", f"[{head}.{_key(name)}]")
            yield from (f"{_key(inner)} = {toml_value(value)}" for inner, value in entry.items())


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else toml_value(name)


def toml_value(value: Any) -> str:
    """A value as TOML text, a table on one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(key)} = {toml_value(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return re.sub("\x7f", r"\\u007f", json.dumps(value, ensure_ascii=False))
    return repr(value)
