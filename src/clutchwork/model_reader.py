"""From the plain data of a model file to a driveline: names, units, types; every mistake is collected."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, replace
from typing import Any

from clutchwork.checks import BROKEN, CHECKS, At, value_problems
from clutchwork.driveline import Driveline
from clutchwork.errors import Problem, near
from clutchwork.model_checks import NODE_FIELDS, node_path
from clutchwork.model_references import References, is_named, referred
from clutchwork.node import HOUSING, Component, Domain, Node, ThermalNode
from clutchwork.quantity import QuantityError, curve_in_si, factor_to_si, in_si, numbers_in_si
from clutchwork.schema import REGISTRY, Role, Spec, specs
from clutchwork.signals.column import Column
from clutchwork.thermal_checks import NODE_FIELDS as THERMAL_FIELDS

FORMAT = 1
TOP = ("format", "name", "description", "shaft", "mass", "thermal", "ambient", "element", "simulation")
ELEMENTS = tuple(role for role in Role if role not in (Role.LAW, Role.SIGNAL))
SIMULATION = {
    "t_end": Spec("param", "s", "end time", above=0.0),
    "dt": Spec("param", "s", "spacing of the output", above=0.0),
    "rtol": Spec("param", "1", "relative tolerance", above=0.0),
    "atol": Spec("param", "1", "absolute tolerance", above=0.0),
    "max_step": Spec("param", "s", "largest step", above=0.0),
    "method": Spec("text", "", "auto, rodas5p or dopri5"),
}


def element_kinds() -> dict[str, Any]:
    """All kinds of elements that a model file may name."""
    return {kind: cls for role in ELEMENTS for kind, cls in REGISTRY[role].items()}


class Reader:
    """Turns plain data into a driveline and collects what is wrong with it."""

    def __init__(self, folder: str) -> None:
        self.folder = folder
        self.problems: list[Problem] = []
        self.nodes: dict[str, Node] = {HOUSING.name: HOUSING}
        self.thermal: dict[str, ThermalNode] = {}
        self.elements = References(self._element)
        self.incomplete: list[str] = []  # nodes at elements that could not be made

    def driveline(self, data: Any) -> Driveline:
        """Everything that can be made of the data."""
        if not isinstance(data, Mapping):
            self._report(At("file", ""), "must be a table", remedy="see the guide on model files")
            return Driveline()
        self._unknown(data, TOP, At("file", ""))
        if data.get("format", FORMAT) != FORMAT:
            remedy = f"this version reads format {FORMAT}"
            self._report(At("file", "format"), "is not known", repr(data["format"]), remedy)
        driveline = Driveline(self._text(data, "name", At("file", ""), "driveline"))
        for kind, domain in (("shaft", Domain.ROTATION), ("mass", Domain.TRANSLATION)):
            for place, entry in self._entries(data, kind):
                self._node(driveline, entry, domain, kind, place)
        for kind in THERMAL_FIELDS:
            for place, entry in self._entries(data, kind):
                self._thermal_node(driveline, entry, kind, place)
        for element in self.elements.all(self._entries(data, "element")):
            driveline.add(element)
        driveline.simulation.update(self._simulation(data.get("simulation", {})))
        return driveline

    def _report(self, at: At, message: str, value: str = "", remedy: str = "") -> Any:
        self.problems.append(at.problem(message, value, remedy))
        return BROKEN

    def _unknown(self, data: Mapping[str, Any], known: Any, at: At) -> None:
        for key in data:
            if key not in known:
                remedy = f"known are {', '.join(known)}"
                self._report(at.inner(str(key)), "is not known here" + near(key, known), remedy=remedy)

    def _entries(self, data: Mapping[str, Any], kind: str) -> list[tuple[int, Mapping[str, Any]]]:
        entries = data.get(kind, [])
        if not isinstance(entries, list) or not all(isinstance(entry, Mapping) for entry in entries):
            self._report(At("file", kind), "must be a list of tables", remedy=f"write [[{kind}]] above each")
            return []
        return list(enumerate(entries, 1))

    def _text(self, data: Mapping[str, Any], key: str, at: At, default: str = "") -> str:
        value = data.get(key, default)
        if isinstance(value, str) and value:
            return value
        message = "must be a text" if key in data else "is missing"
        self._report(at.inner(key), message, repr(value) if key in data else "", f"give a {key}")
        return default

    def _node(self, driveline: Driveline, entry: Mapping[str, Any], domain: Domain, kind: str, place: int) -> None:
        name = self._text(entry, "name", At(f"{kind} number {place}", ""))
        known, at = NODE_FIELDS[domain], At(node_path(kind, name or f"number {place}"), "")
        self._unknown(entry, ("name", *known), at)
        values: list[Any] = [
            self._number(entry[key], spec, at.inner(key, spec.unit)) if key in entry else None
            for key, spec in known.items()
        ]
        # a mistake is reported already: stand-ins let the rest be checked
        inertia, speed, angle = (
            stand_in if v is BROKEN else v for v, stand_in in zip(values, (1.0, None, 0.0), strict=True)
        )
        node = driveline.add_node(Node(name, domain, 0.0 if inertia is None else inertia, speed, angle or 0.0))
        self.nodes.setdefault(name, node)

    def _thermal_node(self, driveline: Driveline, entry: Mapping[str, Any], kind: str, place: int) -> None:
        name = self._text(entry, "name", At(f"{kind} number {place}", ""))
        known, at = THERMAL_FIELDS[kind], At(node_path(kind, name or f"number {place}"), "")
        self._unknown(entry, ("name", *known), at)
        # a mistake is reported already: stand-ins let the rest be checked
        values: dict[str, Any] = {"capacity": 1.0} if kind == "thermal" else {}
        for key, spec in known.items():
            value = self._value(entry[key], spec, at.inner(key, spec.unit)) if key in entry else MISSING
            if value is MISSING and key == "capacity":
                self._report(at.inner(key), "is missing", remedy=f"give a value in [{spec.unit}]: {spec.doc}")
            elif value not in (MISSING, BROKEN):
                values[key] = value
        self.thermal.setdefault(name, driveline.add_thermal(ThermalNode(name, **values)))

    def _element(self, entry: Mapping[str, Any], place: int) -> Component | None:
        name = self._text(entry, "name", At(f"element number {place}", ""))
        path, known = f'element "{name}"' if name else f"element number {place}", element_kinds()
        kind = self._text(entry, "type", At(path, ""))
        before = len(self.problems)
        if kind and kind not in known:
            remedy = f"known are {', '.join(known)}"
            self._report(At(path, "type"), "is not known" + near(kind, known), repr(kind), remedy)
        elif kind:
            values = self._values(known[kind], entry, At(f"{path} ({kind})", ""), ("name", "type"))
            if name and len(self.problems) == before:
                made: Component = known[kind](name, **values)
                return made
        self.incomplete += [value for value in entry.values() if isinstance(value, str)]
        return None

    def _values(self, cls: type, entry: Mapping[str, Any], at: At, taken: tuple[str, ...]) -> dict[str, Any]:
        """Values of the fields of a declaration, in SI; mistakes are reported."""
        known = {item.name: _with_gain(item.name, spec, cls, entry) for item, spec in specs(cls)}
        self._unknown({key: entry[key] for key in entry if key not in taken}, known, at)
        values = {
            key: self._value(entry[key], spec, _place(at, key, spec)) for key, spec in known.items() if key in entry
        }
        self.problems += value_problems(cls, values, at)
        return values

    def _value(self, value: Any, spec: Spec, at: At) -> Any:
        if spec.what in ("port", "thermal"):
            return self._port(value, spec, at)
        if spec.what == "law":
            return self._typed(value, Role.LAW, at)
        if spec.what in ("signal", "alternative"):
            if is_named(value, self.thermal, self.elements, self.nodes) or self.elements.thermal_part(value):
                return self._other(value, at)
            is_signal = isinstance(value, Mapping) and "type" in value
            return self._signal(value, spec, at) if is_signal else self._number(value, spec, at)
        if spec.what == "curve":
            return self._converted(lambda: curve_in_si(value, spec, at.unit, at.factor), at)
        if spec.what == "numbers":
            return self._converted(lambda: numbers_in_si(value, spec, at.unit), at)
        if spec.what == "function":
            return self._report(at, "cannot stand in a model file", remedy="give it in Python")
        if spec.what == "text" or spec.flag or spec.choices:
            return value
        return self._number(value, spec, at)

    def _number(self, value: Any, spec: Spec, at: At) -> Any:
        return self._converted(lambda: in_si(value, at.unit, spec.units, at.factor, whole=spec.whole), at)

    def _converted(self, convert: Any, at: At) -> Any:
        try:
            return convert()
        except QuantityError as bad:
            return self._report(at, bad.message, bad.value, bad.remedy)

    def _port(self, value: Any, spec: Spec, at: At) -> Any:
        known: Mapping[str, Any] = self.nodes if spec.what == "port" else self.thermal
        if isinstance(value, str) and value in known:
            return known[value]
        part = self.elements.thermal_part(value) if spec.what == "thermal" else None
        if part is not None:
            return part
        what = "shaft" if spec.what == "port" else "thermal node"
        remedy = f"known are {', '.join(known)}" if known else "add one: [[thermal]] or [[ambient]]"
        return self._report(at, f"is no {what} of this model" + near(str(value), known), repr(value), remedy)

    def _other(self, value: Any, at: At) -> Any:
        """An input that a thermal node, an element or a shaft gives."""
        name = value["of"] if isinstance(value, Mapping) else value
        found: Any = self.thermal.get(name) or self.elements.thermal_part(name)
        found = found or self.elements.get(name) or self.nodes.get(name)
        if name in self.elements and found is None:
            # its own mistakes are reported where it stands
            return BROKEN if self.elements.broken(name) else self._report(at, "leads back to itself", repr(name))
        if found is None:
            known = [*self.thermal, *self.elements, *self.nodes]
            remedy = f"known are {', '.join(known)}"
            return self._report(at, "is not known" + near(str(name), known), repr(name), remedy)
        return found if isinstance(value, str) else referred(value, found)

    def _typed(self, value: Any, role: Role, at: At, taken: tuple[str, ...] = ("type",)) -> Any:
        """A law or a signal from a table with its type."""
        known = REGISTRY[role]
        if not isinstance(value, Mapping) or "type" not in value:
            remedy = f'write {{type = "...", ...}} with one of {", ".join(known)}'
            return self._report(at, f"must be a table with the type of a {role.value}", repr(value), remedy)
        kind = value["type"]
        if kind not in known:
            remedy = f"known are {', '.join(known)}"
            return self._report(at.inner("type"), "is not known" + near(str(kind), known), repr(kind), remedy)
        before = len(self.problems)
        values = self._values(known[kind], value, at, taken)
        return known[kind](**values) if len(self.problems) == before else BROKEN

    def _signal(self, value: Mapping[str, Any], spec: Spec, at: At) -> Any:
        """A signal; with `unit` its plain numbers are in that unit."""
        factor: Any = 1.0
        if "unit" in value:
            factor = self._converted(lambda: factor_to_si(value["unit"], at.unit, spec.units), at.inner("unit"))
        place = At(at.path, at.quantity, at.unit, 1.0 if factor is BROKEN else factor)
        signal = self._typed(value, Role.SIGNAL, place, ("type", "unit"))
        if isinstance(signal, Column):
            signal = replace(signal, scale=signal.scale * place.factor, folder=self.folder)
        return BROKEN if factor is BROKEN else signal

    def _simulation(self, data: Any) -> dict[str, Any]:
        at = At("simulation", "")
        if not isinstance(data, Mapping):
            return self._report(at, "must be a table", repr(data), "write [simulation] above its lines") and {}
        self._unknown(data, SIMULATION, at)
        made = {}
        for key, spec in SIMULATION.items():
            if key in data:
                place = at.inner(key, spec.unit)
                made[key] = data[key] if spec.what == "text" else self._number(data[key], spec, place)
                if made[key] is not BROKEN:
                    self.problems += _simulation_problems(made[key], spec, place)
        return made


def _place(at: At, key: str, spec: Spec) -> At:
    """Place of a field; one in the unit of what a signal drives takes over that unit and its factor."""
    return At(at.path, at.inner(key).quantity, at.unit, at.factor) if spec.unit == "*" else at.inner(key, spec.unit)


def _with_gain(name: str, spec: Spec, cls: type, entry: Mapping[str, Any]) -> Spec:
    """The spec of a gain with only the units that fit what it multiplies: a pressure or a force."""
    gains = [other.gain for item, other in specs(cls) if other.gain and item.name in entry]
    return replace(spec, unit=gains[0][0], units=gains[0][1:]) if name == "gain" and len(gains) == 1 else spec


def _simulation_problems(value: Any, spec: Spec, at: At) -> list[Problem]:
    from clutchwork.options import METHODS

    found = list(CHECKS[spec.what](value, spec, at))
    if spec.what == "text" and not found and value not in METHODS:
        found.append(at.problem("is not known" + near(value, METHODS), repr(value), f"known are {', '.join(METHODS)}"))
    return found
