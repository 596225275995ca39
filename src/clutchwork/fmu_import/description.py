"""What an FMU says of itself: modelDescription.xml of FMI 2.0 and 3.0, read without any definition of its own."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from math import isfinite
from xml.etree.ElementTree import Element, ParseError, TreeBuilder, XMLParser

from clutchwork.base import FMUError, dataclass, listed, near, quote
from clutchwork.declare.unit_words import OTHER_ZERO
from clutchwork.declare.units import Scale, parse

VERSIONS = ("2.0", "3.0")
# types whose values are numbers, by the function that reads and sets them
TYPES = {
    "2.0": {"Real": "Real", "Integer": "Integer", "Enumeration": "Integer", "Boolean": "Boolean"},
    "3.0": {"Enumeration": "Int64", "Boolean": "Boolean", "Float64": "Float64", "Float32": "Float32"}
    | {f"{sign}Int{bits}": f"{sign}Int{bits}" for sign in ("", "U") for bits in (8, 16, 32, 64)},
}
# part of a path, so nothing but a word
IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
MOST_REFERENCE = 2**32 - 1
INPUT, PARAMETER, OUTPUT = "input", "parameter", "output"
WORDS = {INPUT: "an input", PARAMETER: "a parameter", OUTPUT: "an output"}


@dataclass(frozen=True)
class FMUVariable:
    """A variable of an FMU; a number of it times the scale is one in SI."""

    name: str
    reference: int
    causality: str
    type: str  # of its functions; empty where it is no number
    unit: str
    scale: Scale
    settable: bool  # before the start


@dataclass(frozen=True)
class Description:
    """An FMU for co-simulation."""

    version: str  # "2.0" or "3.0"
    name: str  # of its model
    identifier: str  # of its library
    token: str
    variables: dict[str, FMUVariable]

    def variable(self, name: str, wanted: str) -> FMUVariable:
        """A variable that can be read as an output, or set as an input or a parameter; FMUError where none is that."""
        found = self.variables.get(name) if isinstance(name, str) else None
        fits = [one.name for one in self.variables.values() if one.type and _is(one, wanted)]
        if found is None or not _is(found, wanted):
            fixed = found is not None and found.causality == wanted
            what = "is a parameter that cannot be set" if fixed else f"is not {WORDS[wanted]}"
            known = f"{wanted}s are {listed(fits)}" if fits else f"it has no {wanted}s"
            raise FMUError(f"{quote(name)} {what}{near(name, fits, known)}")
        if not found.type:
            raise FMUError(f"{quote(name)} is not a single number, and only those can be exchanged")
        return found


def _is(one: FMUVariable, wanted: str) -> bool:
    # a number that is no output may be looked at too, and what no signal drives may keep a value
    if wanted == OUTPUT:
        return one.causality in (OUTPUT, "local")
    return one.settable if wanted == PARAMETER else one.causality == wanted


class _Builder(TreeBuilder):
    """Builds a tree and refuses definitions, which may be of any size."""

    def doctype(self, name: str, public: str | None, system: str | None) -> None:  # noqa: ARG002, all are refused
        raise FMUError("its description has a DOCTYPE, which no FMU needs")


def read(data: bytes) -> Description:
    """A description; FMUError says what is wrong."""
    parser = XMLParser(target=_Builder())  # noqa: S314, definitions are refused
    try:
        parser.feed(data)
        root: Element = parser.close()
    except (ParseError, ValueError, LookupError) as error:
        if isinstance(error, FMUError):
            raise
        raise FMUError(f"its description is not XML: {error}") from None
    version = root.get("fmiVersion", "")
    if root.tag != "fmiModelDescription" or not version.startswith(VERSIONS):
        raise FMUError(f"it is of FMI {quote(version)}; what can be run is {' and '.join(VERSIONS)}")
    kept = version[:3]
    run = root.find("CoSimulation")
    if run is None:
        raise FMUError("it does not support co-simulation: ask its supplier for an FMU that does")
    identifier = run.get("modelIdentifier", "")
    if not IDENTIFIER.fullmatch(identifier):
        raise FMUError(f"its modelIdentifier is {quote(identifier)}, which cannot be the name of a library")
    token = root.get("instantiationToken" if kept == "3.0" else "guid", "")
    units = dict(_units(root))
    made = {one.name: one for one in _variables(root, kept, units)}
    return Description(kept, root.get("modelName", identifier), identifier, token, made)


def _variables(root: Element, version: str, units: dict[str, Scale]) -> Iterator[FMUVariable]:
    found = root.find("ModelVariables")
    types = _types(root)
    for item in () if found is None else found:
        typed = item if version == "3.0" else next((one for one in item if one.tag in TYPES["2.0"]), None)
        kind = "" if typed is None or item.find("Dimension") is not None else TYPES[version].get(typed.tag, "")
        unit = "" if typed is None else typed.get("unit") or types.get(typed.get("declaredType", ""), "")
        scale = _relative(units.get(unit) or _by_name(unit), typed)
        causality = item.get("causality", "local")
        yield FMUVariable(item.get("name", ""), _reference(item), causality, kind, unit, scale, _settable(item, typed))


def _reference(item: Element) -> int:
    with suppress(ValueError):
        number = int(item.get("valueReference", ""))
        if 0 <= number <= MOST_REFERENCE:
            return number
    raise FMUError(f"its variable {quote(item.get('name', ''))} has no valueReference")


def _settable(item: Element, typed: Element | None) -> bool:
    """Whether a value may be given before the start."""
    if item.get("variability") == "constant" or typed is None or item.get("causality") == OUTPUT:
        return False
    given = "start" in typed.attrib and item.get("initial", "exact") != "calculated"
    return item.get("causality") in (PARAMETER, INPUT) or given


def _types(root: Element) -> dict[str, str]:
    """Units of declared types."""
    found = {}
    for item in root.iterfind("TypeDefinitions/*"):
        unit = item.get("unit") or next((one.get("unit") for one in item if one.get("unit")), None)
        found[item.get("name", "")] = unit or ""
    return found


def _units(root: Element) -> Iterator[tuple[str, Scale]]:
    for item in root.iterfind("UnitDefinitions/Unit"):
        base = item.find("BaseUnit")
        if base is None:
            continue
        name = item.get("name", "")
        try:
            factor, zero = float(base.get("factor", "1")), float(base.get("offset", "0"))
        except ValueError:
            factor, zero = 0.0, 0.0
        if factor == 0.0 or not (isfinite(factor) and isfinite(zero)):
            raise FMUError(f"its unit {quote(name)} has a factor or an offset that is not a number")
        yield name, Scale(factor, zero)


def _by_name(unit: str) -> Scale:
    """What a unit without definition is by its name; a number as it is where that says nothing."""
    if unit in OTHER_ZERO:
        return Scale(*OTHER_ZERO[unit])
    with suppress(ValueError):
        return Scale(parse(unit).factor) if unit else Scale(1.0)
    return Scale(1.0)


def _relative(scale: Scale, typed: Element | None) -> Scale:
    """The scale of a difference, which has no other zero."""
    difference = typed is not None and typed.get("relativeQuantity") in ("true", "1")
    return Scale(scale.factor) if difference else scale
