"""Values of a model file: numbers with units, signals, laws, ports and references, checked against the declarations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from clutchwork.base import FMUError, Problem, listed, near, quote
from clutchwork.declare.node import HOUSING, Domain, Node, ThermalNode
from clutchwork.declare.quantity import PLAIN, QuantityError, in_si, scale_to_si
from clutchwork.declare.schema import REGISTRY, Role, Spec, inputs, specs
from clutchwork.declare.to_si import in_tuples, settled
from clutchwork.files.lists import curve_in_si, list_in_si
from clutchwork.files.references import References, is_named, referred
from clutchwork.model.components import type_problem
from clutchwork.model.fields import BROKEN, mark_sound, value_problems
from clutchwork.model.numbers import At
from clutchwork.signals.column import Column

T = TypeVar("T")


ELEMENTS = tuple(role for role in Role if role not in (Role.LAW, Role.SIGNAL))
# what a port of a domain may be
PORTS = {"rotation": "shaft", "translation": "mass", "": "shaft or mass"}


@cache
def element_kinds() -> dict[str, Any]:
    """All kinds of elements that a model file may name."""
    return {kind: cls for role in ELEMENTS for kind, cls in REGISTRY[role].items()}


@cache
def _fields(cls: Any) -> Mapping[str, Spec]:
    """The fields of a declaration by name."""
    return {item.name: spec for item, spec in specs(cls)}


def is_path(value: Any) -> bool:
    """Whether what a composite is built by is the path of a file."""
    return isinstance(value, str) and value.lower().endswith((".toml", ".json"))


class ValueReader:
    """Turns the values of one file into those of fields; every mistake is collected."""

    def __init__(self, folder: str, elements: References) -> None:
        self.folder = folder
        self.elements = elements
        self.problems: list[Problem] = []
        self.nodes: dict[str, Node] = {HOUSING.name: HOUSING}
        self.thermal: dict[str, ThermalNode] = {}
        self.fmus: dict[str, Any] = {}  # of other people, BROKEN where one cannot be used
        self.strays: dict[str, str] = {}  # names in tables whose heads are misspelt

    def _report(self, at: At, message: str, value: str = "", remedy: str = "") -> Any:
        self.problems.append(at.problem(message, value, remedy))
        return BROKEN

    def _unknown(self, data: Iterable[str], known: Any, at: At) -> None:
        told = False
        for key in data:
            if key not in known:
                # the list of all is only said once, and not where a near one says enough
                meant = near(key, known)
                rest = "" if meant or told else f"known keys: {listed(known)}"
                self._report(at.inner(str(key)), "is an unknown key" + meant, remedy=rest)
                told = told or not meant

    def _values(self, cls: type, entry: Mapping[str, Any], at: At, taken: tuple[str, ...]) -> dict[str, Any]:
        """Values of the fields of a declaration, in SI; mistakes are reported."""
        values = self._read(cls, _fields(cls), entry, at, taken)
        for item, _ in specs(cls, "elements"):
            key = item.name
            if isinstance(values.get(key), Mapping):
                values[key] = self._described(values[key], cls.entry_kinds(values), at.inner(key))  # type: ignore[attr-defined]
        self.problems += value_problems(cls, values, at)
        # lists could be changed by their owner, and the reader has none
        for key, value in values.items():
            if type(value) is list:
                values[key] = in_tuples(value)
        return values

    def _read(
        self, cls: type, known: Mapping[str, Spec], entry: Mapping[str, Any], at: At, taken: tuple[str, ...]
    ) -> dict[str, Any]:
        """Values of the known fields of a declaration, in SI; what cannot be read is reported."""
        self._unknown([key for key in entry if key not in taken], known, at)
        values = {}
        for key, spec in known.items():
            if key in entry:
                value = entry[key]
                if spec.units and type(value) is not float:
                    spec = settled(key, spec, cls, self._joined(entry, known))
                values[key] = self._value(value, spec, at, key)
        return values

    def _described(self, tables: Mapping[str, Any], kinds: Mapping[str, str], at: At) -> dict[str, Any]:
        """Tables of elements of a composite, their values in SI; what they leave out may follow from the composite."""
        made = {}
        for name, table in tables.items():
            place = at.inner(name)
            made[name] = table
            if not isinstance(table, Mapping):
                continue
            kind = table.get("type", kinds.get(place.quantity))
            if kind is None:
                # of no element that there is, which the composite reports
                continue
            if kind not in element_kinds():
                self.problems.append(type_problem(kind, place))
                continue
            cls = element_kinds()[kind]
            known = {item.name: spec for item, spec in specs(cls) if spec.what != "port"}
            values = self._read(cls, known, table, place, ("type",))
            rest: dict[str, Any] = dict.fromkeys((item.name for item, _ in specs(cls)), BROKEN)
            rest |= dict.fromkeys((way for ways, _ in inputs(cls) for way in ways), None)
            found = value_problems(cls, {**rest, **values}, place)
            self.problems += [problem for problem in found if problem.quantity.split(".")[2] in values]
            made[name] = {**({"type": kind} if "type" in table else {}), **values}
        return made

    def _value(self, value: Any, spec: Spec, owner: At, key: str) -> Any:
        if type(value) is float and spec.what == "param" and spec.unit != "*":
            # minus zero becomes zero, so that what is written reads back to the same bits
            return value + 0.0
        if spec.what == "port" and type(value) is str and value in self.nodes:
            return self.nodes[value]
        at = _place(owner, key, spec)
        if spec.what in ("port", "thermal"):
            return self._port(value, spec, at)
        if spec.what == "law":
            return self._typed(value, Role.LAW, at)
        if spec.what in ("signal", "alternative"):
            if is_named(value, self.thermal, self.elements, self.nodes) or self.elements.part(value):
                return self._other(value, at)
            is_signal = isinstance(value, Mapping) and ("type" in value or "fmu" in value)
            return self._signal(value, spec, at) if is_signal else self._number(value, spec, at)
        if spec.what == "curve":
            return self._converted(lambda: curve_in_si(value, spec, at), at)
        if spec.what == "numbers":
            return self._converted(lambda: list_in_si(value, spec, at), at)
        if spec.what == "function":
            return self._report(at, "is not allowed in a model file", remedy="build this model in Python")
        if spec.what == "named" and isinstance(value, Mapping):
            return {name: self._number(number, spec, at.inner(name, spec.unit)) for name, number in value.items()}
        if spec.what == "data" and is_path(value):
            return str(Path(self.folder, value))
        if spec.what in ("text", "formula", "elements", "named", "data") or spec.flag or spec.choices:
            return value
        return self._number(value, spec, at)

    def _number(self, value: Any, spec: Spec, at: At) -> Any:
        scale = at.scale
        if spec.difference and scale.zero:
            remedy = "give its values as strings, and differences in K: 10 K"
            return self._report(at, "is a difference of temperatures, which degrees have no zero for", remedy=remedy)
        if type(value) is float and not spec.whole:
            # minus zero becomes zero, so that what is written reads back to the same bits
            return value + 0.0 if scale is PLAIN else scale.si(value)
        others = (*spec.units, *at.units)
        return self._converted(
            lambda: in_si(
                value, at.unit, others, scale.factor, whole=spec.whole, difference=spec.difference, zero=scale.zero
            ),
            at,
        )

    def _converted(self, convert: Any, at: At) -> Any:
        try:
            return convert()
        except QuantityError as bad:
            return self._report(at, bad.message, bad.value, bad.remedy)

    def _joined(self, entry: Mapping[str, Any], known: Mapping[str, Spec]) -> dict[str, Any]:
        """The entries of fields, nodes at the ports."""
        return {
            key: self._node_of(value) if known[key].what == "port" else value
            for key, value in entry.items()
            if key in known
        }

    def _node_of(self, name: Any) -> Any:
        """The shaft or mass of a name; nothing where there is none."""
        return (self.nodes.get(name) or self.elements.part(name)) if isinstance(name, str) else None

    def _port(self, value: Any, spec: Spec, at: At) -> Any:
        known: Mapping[str, Any] = self.nodes if spec.what == "port" else self.thermal
        if isinstance(value, str) and value in known:
            return known[value]
        part = self.elements.part(value)
        if isinstance(part, ThermalNode if spec.what == "thermal" else Node):
            return part
        if self.elements.unknown_part(value):
            return BROKEN
        moving = any(node.domain is Domain.TRANSLATION for node in self.nodes.values())
        what = PORTS[spec.domain if moving else spec.domain or "rotation"] if spec.what == "port" else "thermal node"
        if isinstance(value, str) and value in self.strays:
            remedy = f"it stands in [[{self.strays[value]}]]: write [[{what.partition(' ')[0]}]]"
            return self._report(at, f"is not a {what} of this model", quote(value), remedy)
        fits = [name for name in known if _is_of(known[name], spec)]
        many = {"mass": "masses", "shaft or mass": "shafts and masses"}.get(what, f"{what}s")
        remedy = f"known {many}: {listed(fits)}" if fits else "add one: [[thermal]] or [[ambient]]"
        return self._report(at, f"is not a {what} of this model" + near(value, fits), quote(value), remedy)

    def _other(self, value: Any, at: At) -> Any:
        """An input that a thermal node, an element or a shaft gives."""
        name = value["of"] if isinstance(value, Mapping) else value
        found: Any = self.thermal.get(name) or self.elements.part(name)
        found = found or self.elements.get(name) or self.nodes.get(name)
        if name in self.elements and found is None:
            # its own mistakes are reported where it stands
            return BROKEN if self.elements.broken(name) else self._report(at, "refers back to itself", quote(name))
        if found is None and self.elements.unknown_part(name):
            return BROKEN
        if found is None:
            known = [*self.thermal, *self.elements, *self.nodes]
            message = "is not a thermal node, element or shaft of this model" + near(name, known)
            return self._report(at, message, quote(name), f"known names: {listed(known)}")
        return found if isinstance(value, str) else referred(value, found)

    def _guest(self, value: Mapping[str, Any], at: At) -> Any:
        """An output of an FMU of other people."""
        self._unknown(value, ("fmu", "output"), at)
        found = self.fmus.get(value["fmu"]) if isinstance(value["fmu"], str) else None
        if found is None:
            known = f"FMUs are {listed(self.fmus)}" if self.fmus else "add one: [[fmu]]"
            message = "is not an FMU of this model" + near(value["fmu"], self.fmus)
            return self._report(at.inner("fmu"), message, quote(value["fmu"]), known)
        if found is BROKEN:
            return BROKEN
        try:
            return found[value.get("output")]
        except FMUError as error:
            return self._report(at.inner("output"), str(error), quote(value.get("output")))

    def _typed(self, value: Any, role: Role, at: At, taken: tuple[str, ...] = ("type",)) -> Any:
        """A law or a signal from a table with its type."""
        known = REGISTRY[role]
        if not isinstance(value, Mapping) or "type" not in value:
            remedy = f'write {{type = "...", ...}}; known types: {listed(known)}'
            return self._report(at, f"must be a table with the type of a {role.value}", quote(value), remedy)
        kind = value["type"]
        if not isinstance(kind, str) or kind not in known:
            remedy = f"known types: {listed(known)}"
            return self._report(at.inner("type"), "is an unknown type" + near(kind, known), quote(kind), remedy)
        before, cls = len(self.problems), known[kind]
        if role is Role.LAW:
            cls = cls.declared_by({key: item for key, item in value.items() if key not in taken})
        values = self._values(cls, value, at, taken)
        return self._made(cls(**values)) if len(self.problems) == before else BROKEN

    def _made(self, thing: T) -> T:
        """A declared object whose values were checked as they were read."""
        mark_sound(thing)
        return thing

    def _signal(self, value: Mapping[str, Any], spec: Spec, at: At) -> Any:
        """A signal; with `unit` its plain numbers are in that unit."""
        if "fmu" in value:
            return self._guest(value, at)
        scale: Any = PLAIN
        if "unit" in value:
            scale = self._converted(lambda: scale_to_si(value["unit"], at.unit, spec.units), at.inner("unit"))
        place = At(at.path, at.quantity, at.unit, PLAIN if scale is BROKEN else scale, spec.units)
        signal = self._typed(value, Role.SIGNAL, place, ("type", "unit"))
        if isinstance(signal, Column):
            signal = replace(signal, scale=signal.scale * place.scale.factor, folder=self.folder)
            if place.scale is PLAIN:
                self._made(signal)
            if place.scale.zero:
                remedy = "write the unit into the head of the column: temperature [degC]"
                return self._report(at.inner("unit"), "has another zero than kelvin", quote(value["unit"]), remedy)
            if "unit" in value and place.scale != PLAIN and (unit := replace(signal, scale=1.0).unit()):
                fault = f"cannot be given: the head of the column has the unit [{unit}]"
                return self._report(at.inner("unit"), fault, quote(value["unit"]), "remove unit")
        return BROKEN if scale is BROKEN else signal


def _is_of(node: Any, spec: Spec) -> bool:
    """Whether a port may be on a node."""
    return spec.what != "port" or not spec.domain or node.fixed or node.domain.value == spec.domain


def _place(at: At, key: str, spec: Spec) -> At:
    """Place of a field; one in the unit of what a signal drives takes over that unit and its scale."""
    if spec.unit == "*":
        return At(at.path, at.inner(key).quantity, at.unit, at.scale, at.units)
    return at.inner(key, spec.unit)
