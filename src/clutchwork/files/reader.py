"""From the plain data of a model file to a model: names, units, types; every mistake is collected."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING
from typing import Any

from clutchwork.base import listed, near, quote
from clutchwork.declare.node import Component, Domain, Node, ThermalNode
from clutchwork.declare.options import SIMULATION
from clutchwork.declare.wording import element_path
from clutchwork.files.references import References
from clutchwork.files.values import ValueReader, element_kinds
from clutchwork.model.fields import BROKEN
from clutchwork.model.model import Model
from clutchwork.model.numbers import At
from clutchwork.model.problems import NODE_FIELDS, node_path
from clutchwork.model.thermal import NODE_FIELDS as THERMAL_FIELDS

FORMAT = 1
TOP = ("format", "name", "description", "shaft", "mass", "thermal", "ambient", "fmu", "element", "simulation")


class ModelReader(ValueReader):
    """Turns plain data into a model and collects what is wrong with it."""

    def __init__(self, folder: str, trust: bool = False) -> None:
        super().__init__(folder, References(self._element))
        self.trust = trust  # whether libraries of FMUs may run
        self.incomplete: list[str] = []  # nodes at elements that could not be made

    def model(self, data: Any) -> Model:
        """Everything that can be made of the data."""
        if not isinstance(data, Mapping):
            self._report(At("file", ""), "must be a table", remedy="see the guide on model files")
            return Model()
        self._unknown(data, TOP, At("file", ""))
        self.strays = _named_in({key: value for key, value in data.items() if key not in TOP})
        if data.get("format", FORMAT) != FORMAT:
            remedy = f"this version reads format {FORMAT}"
            self._report(At("file", "format"), "is an unknown format", quote(data["format"]), remedy)
        model = Model(self._text(data, "name", "file", "driveline"))
        if "fmu" in data:
            self._fmus(data)
        for kind, domain in (("shaft", Domain.ROTATION), ("mass", Domain.TRANSLATION)):
            for place, entry in self._entries(data, kind):
                self._node(model, entry, domain, kind, place)
        for kind in THERMAL_FIELDS:
            for place, entry in self._entries(data, kind):
                self._thermal_node(model, entry, kind, place)
        model.elements += self.elements.all(self._entries(data, "element"))
        model.settings.update(self._simulation(data.get("simulation", {})))
        return model

    def _entries(self, data: Mapping[str, Any], kind: str) -> list[tuple[int, Mapping[str, Any]]]:
        entries = data.get(kind, [])
        if not isinstance(entries, list) or not all(isinstance(entry, Mapping) for entry in entries):
            self._report(At("file", kind), "must be a list of tables", remedy=f"write [[{kind}]] above each")
            return []
        return list(enumerate(entries, 1))

    def _text(self, data: Mapping[str, Any], key: str, path: str, default: str = "") -> str:
        value = data.get(key, default)
        if isinstance(value, str) and value:
            return value
        message = "must be a string" if key in data else "is missing"
        self._report(At(path, key), message, quote(value) if key in data else "", f"give a {key}")
        return default

    def _node(self, model: Model, entry: Mapping[str, Any], domain: Domain, kind: str, place: int) -> None:
        name = self._text(entry, "name", f"{kind} number {place}")
        known, at = NODE_FIELDS[domain], At(node_path(kind, name or f"number {place}"), "")
        self._unknown(entry, ("name", *known), at)
        values: list[Any] = [
            self._value(entry[key], spec, at, key) if key in entry else None for key, spec in known.items()
        ]
        # a mistake is reported already: stand-ins let the rest be checked
        inertia, speed, angle = (
            stand_in if v is BROKEN else v for v, stand_in in zip(values, (1.0, None, None), strict=True)
        )
        node = Node(name, domain, 0.0 if inertia is None else inertia, speed, angle)
        model.nodes.append(node)
        self.nodes.setdefault(name, node)

    def _thermal_node(self, model: Model, entry: Mapping[str, Any], kind: str, place: int) -> None:
        name = self._text(entry, "name", f"{kind} number {place}")
        known, at = THERMAL_FIELDS[kind], At(node_path(kind, name or f"number {place}"), "")
        self._unknown(entry, ("name", *known), at)
        # a mistake is reported already: stand-ins let the rest be checked
        values: dict[str, Any] = {"capacity": 1.0} if kind == "thermal" else {}
        for key, spec in known.items():
            value = self._value(entry[key], spec, at, key) if key in entry else MISSING
            if value is MISSING and key == "capacity":
                self._report(at.inner(key), "is missing", remedy=f"give a value in [{spec.unit}]: {spec.doc}")
            elif value not in (MISSING, BROKEN):
                values[key] = value
        node = ThermalNode(name, **values)
        model.thermal.append(node)
        self.thermal.setdefault(name, node)

    def _element(self, entry: Mapping[str, Any], place: int) -> Component | None:
        name = self._text(entry, "name", f"element number {place}")
        path, known = f'element "{name}"' if name else f"element number {place}", element_kinds()
        kind = self._text(entry, "type", path)
        before = len(self.problems)
        if kind and kind not in known:
            remedy = f"known types: {listed(known)}"
            self._report(At(path, "type"), "is an unknown type" + near(kind, known), quote(kind), remedy)
        elif kind:
            values = self._values(known[kind], entry, At(element_path(name, known[kind]), ""), ("name", "type"))
            if name and len(self.problems) == before:
                made: Component = self._made(known[kind](name, **values))
                return made
        self.incomplete += [value for value in entry.values() if isinstance(value, str)]
        return None

    def _fmus(self, data: Mapping[str, Any]) -> None:
        # loaded where a model has one
        from clutchwork.files.fmus import fmu

        for place, entry in self._entries(data, "fmu"):
            name = self._text(entry, "name", f"fmu number {place}")
            made = fmu(entry, name, self.folder, trust=self.trust)
            self.fmus.setdefault(name, BROKEN if isinstance(made, list) else made)
            self.problems += made if isinstance(made, list) else []

    def _simulation(self, data: Any) -> dict[str, Any]:
        at = At("simulation", "")
        if not isinstance(data, Mapping):
            return self._report(at, "must be a table", quote(data), "write [simulation] above its keys") and {}
        made = {}
        for key, value in data.items():
            row = SIMULATION.get(key)
            # an unknown name is reported with the other mistakes of the settings
            made[key] = value if row is None else self._value(value, row.spec, at, key)
        return {key: value for key, value in made.items() if value is not BROKEN}


def _named_in(tables: Mapping[str, Any]) -> dict[str, str]:
    """The table of each name in lists of tables."""
    lists = [(str(key), value) for key, value in tables.items() if isinstance(value, list)]
    entries = [(key, entry.get("name")) for key, value in lists for entry in value if isinstance(entry, Mapping)]
    return {name: key for key, name in entries if isinstance(name, str)}
