"""modelDescription.xml of an FMU, in FMI 2.0 or 3.0."""

from __future__ import annotations

import re
from collections.abc import Iterable
from math import isfinite, pi
from typing import NamedTuple
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from clutchwork.base.bounds import plain
from clutchwork.declare.units import powers_of
from clutchwork.fmu.interface import CO_SIMULATION, MODEL_EXCHANGE, Interface
from clutchwork.fmu.variables import FmuVariable, VariableKind

CATEGORIES = (
    ("error", "why a call failed"),
    ("warning", "what is taken otherwise than it was asked for"),
    ("events", "contacts that lock, slip and break away"),
)
# steps that a master takes where it is told none, in one run [1]
STEPS = 1000
COPYRIGHT = {"license": "Apache-2.0 (the core)"}
WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
# in the order of the powers of declare.units
BASES = ("kg", "m", "s", "rad", "K", "A")


def description(made: Interface, identifier: str, token: str, version: str, tool: str) -> bytes:
    """The description of an FMU; version, "2.0" or "3.0"."""
    root = Element("fmiModelDescription", fmiVersion=version, modelName=made.system.name or identifier)
    root.set("instantiationToken" if version == "3.0" else "guid", token)
    root.set("description", "driveline with friction contacts that lock, slip and break away exactly")
    root.set("generationTool", tool)
    for name, value in COPYRIGHT.items():
        root.set(name, value)
    root.set("variableNamingConvention", "structured" if all(map(is_ascii, _names(made))) else "flat")
    if version == "2.0":
        root.set("numberOfEventIndicators", str(len(made.of(VariableKind.MARGIN))))
    (_add_three if version == "3.0" else _add_two)(root, made, identifier)
    indent(root)
    content: bytes = tostring(root, encoding="utf-8")
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + content + b"\n"


def is_ascii(name: str) -> bool:
    """Whether a name has no letters beyond ASCII, which structured names do not have."""
    return name.isascii()


def structured(name: str) -> str:
    """A name in the structured convention of FMI: words that are not identifiers are quoted."""
    inside = re.fullmatch(r"der\((.*)\)", name)
    if inside:
        return f"der({structured(inside[1])})"
    if not is_ascii(name):
        return name
    return ".".join(_word(word) for word in name.split("."))


def _word(word: str) -> str:
    name, index = re.fullmatch(r"(.*?)((?:\[\d+(?:,\s*\d+)*\])?)", word, re.DOTALL).groups()  # type: ignore[union-attr]
    if WORD.fullmatch(name):
        return name + index
    escaped = name.replace("\\", "\\\\").replace("'", "\\'")
    return f"'{escaped}'{index}"


def _names(made: Interface) -> list[str]:
    return [one.name for one in made.variables]


def _experiment(root: Element, made: Interface) -> None:
    start, stop = made.options.t_start, made.t_end
    times = {"startTime": start, "stopTime": stop, "tolerance": made.options.rtol, "stepSize": (stop - start) / STEPS}
    SubElement(root, "DefaultExperiment", {name: repr(float(value)) for name, value in times.items()})


def _categories(root: Element) -> None:
    found = SubElement(root, "LogCategories")
    for name, words in CATEGORIES:
        SubElement(found, "Category", name=name, description=words)


def _common(one: FmuVariable, number: int) -> dict[str, str]:
    found = {"name": structured(one.name), "valueReference": str(number)}
    return found | ({"description": one.about} if one.about else {})


def _role(one: FmuVariable) -> dict[str, str]:
    """Causality, variability and initial value of a variable."""
    if one.kind in (VariableKind.INPUT, VariableKind.SLOPE):
        return {"causality": "input", "variability": "continuous"}
    if one.kind is VariableKind.TUNABLE:
        return {"causality": "parameter", "variability": "tunable", "initial": "exact"}
    if one.kind is VariableKind.FIXED:
        return {"causality": "parameter", "variability": "fixed", "initial": "exact"}
    if one.kind is VariableKind.TIME:
        return {"causality": "independent", "variability": "continuous"}
    variability = "discrete" if one.kind is VariableKind.MODE else "continuous"
    return {"causality": "local" if one.hidden else "output", "variability": variability, "initial": "calculated"}


def _number(one: FmuVariable) -> dict[str, str]:
    """Unit, bounds and start."""
    if one.kind is VariableKind.MODE:
        return {"min": "-1", "max": "2"}
    bounds = {
        name: repr(value) for name, value in zip(("min", "max"), plain(one.bounds), strict=True) if isfinite(value)
    }
    given = one.kind in (VariableKind.INPUT, VariableKind.SLOPE, VariableKind.TUNABLE, VariableKind.FIXED)
    size = {"nominal": repr(one.nominal)} if one.nominal else {}
    return unit_attributes(one.unit) | bounds | size | ({"start": repr(one.start)} if given else {})


def _dependencies(one: FmuVariable, is_output: bool) -> dict[str, str]:
    """What an output that follows from states says: importers then see no algebraic loop."""
    return {"dependencies": ""} if one.follows_states and is_output else {}


def _units(made: Interface) -> list[str]:
    return [one.unit for one in made.variables if one.kind is not VariableKind.MODE]


def _has_rates(made: Interface) -> bool:
    """Whether outputs have derivatives in co-simulation: a step of fixed length has a mean rate alone."""
    return made.options.method != "fixed"


def _outputs(made: Interface) -> list[tuple[int, FmuVariable]]:
    return [(number, one) for number, one in made.of(VariableKind.SIGNAL, VariableKind.MODE) if not one.hidden]


def _unknowns(made: Interface) -> list[int]:
    """Value references of what is computed at the start: outputs, continuous states and their rates."""
    more = {number for state in made.states for number in (state.variable, state.rate)}
    return sorted({number for number, _ in _outputs(made)} | more)


# ------------------------------------------------------------------------------------------------------------- FMI 2.0

STATES_TWO = {"canGetAndSetFMUstate": "true", "canSerializeFMUstate": "true"}


def _add_two(root: Element, made: Interface, identifier: str) -> None:
    common = {"modelIdentifier": identifier, "canNotUseMemoryManagementFunctions": "true"} | STATES_TWO
    derives = {"providesDirectionalDerivative": "true"}
    if MODEL_EXCHANGE in made.kinds:
        SubElement(root, "ModelExchange", common | derives | {"completedIntegratorStepNotNeeded": "true"})
    if CO_SIMULATION in made.kinds:
        steps = {"canHandleVariableCommunicationStepSize": "true", "canInterpolateInputs": "true"}
        rates = {"maxOutputDerivativeOrder": "1"} | derives if _has_rates(made) else {"maxOutputDerivativeOrder": "0"}
        SubElement(root, "CoSimulation", common | steps | rates)
    add_units(root, _units(made))
    _categories(root)
    _experiment(root, made)
    left = (VariableKind.TIME, VariableKind.SLOPE, VariableKind.MARGIN)
    listed = [(n, one) for n, one in enumerate(made.variables) if one.kind not in left]
    index = {number: place for place, (number, _) in enumerate(listed, start=1)}
    variables = SubElement(root, "ModelVariables")
    for number, one in listed:
        scalar = SubElement(variables, "ScalarVariable", _common(one, number) | _role(one))
        of = {"derivative": str(index[made.states[one.of].variable])} if one.kind is VariableKind.RATE else {}
        again = {"reinit": "true"} if one.state >= 0 else {}
        SubElement(scalar, "Integer" if one.kind is VariableKind.MODE else "Real", _number(one) | of | again)
    structure = SubElement(root, "ModelStructure")
    parts: dict[str, list[tuple[int, dict[str, str]]]] = {
        "Outputs": [(number, _dependencies(one, True)) for number, one in _outputs(made)],
        "Derivatives": [(state.rate, {}) for state in made.states],
        "InitialUnknowns": [(number, {}) for number in _unknowns(made)],
    }
    for part, unknowns in parts.items():
        if unknowns:
            listing = SubElement(structure, part)
            for number, depends in sorted(unknowns, key=lambda found: index[found[0]]):
                SubElement(listing, "Unknown", {"index": str(index[number])} | depends)


# ------------------------------------------------------------------------------------------------------------- FMI 3.0

STATES_THREE = {"canGetAndSetFMUState": "true", "canSerializeFMUState": "true"}
DERIVES_THREE = {"providesDirectionalDerivatives": "true", "providesAdjointDerivatives": "true"}


def _add_three(root: Element, made: Interface, identifier: str) -> None:
    common = {"modelIdentifier": identifier} | STATES_THREE
    if MODEL_EXCHANGE in made.kinds:
        SubElement(root, "ModelExchange", common | DERIVES_THREE | {"needsCompletedIntegratorStep": "false"})
    if CO_SIMULATION in made.kinds:
        _add_steps(root, made, common)
    add_units(root, _units(made))
    _categories(root)
    _experiment(root, made)
    variables = SubElement(root, "ModelVariables")
    for number, one in enumerate(made.variables):
        of = {"derivative": str(one.of)} if one.kind is VariableKind.SLOPE else {}
        if one.kind is VariableKind.RATE:
            of = {"derivative": str(made.states[one.of].variable)}
        again = {"reinit": "true"} if one.state >= 0 else {}
        kind = "Int32" if one.kind is VariableKind.MODE else "Float64"
        SubElement(variables, kind, _common(one, number) | _role(one) | _number(one) | of | again)
    structure = SubElement(root, "ModelStructure")
    for number, one in _outputs(made):
        SubElement(structure, "Output", {"valueReference": str(number)} | _dependencies(one, True))
    parts = {
        "ContinuousStateDerivative": [state.rate for state in made.states],
        "InitialUnknown": _unknowns(made),
        "EventIndicator": [number for number, _ in made.of(VariableKind.MARGIN)],
    }
    for part, references in parts.items():
        for number in references:
            SubElement(structure, part, {"valueReference": str(number)})


def _add_steps(root: Element, made: Interface, common: dict[str, str]) -> None:
    able = dict.fromkeys(
        ("canHandleVariableCommunicationStepSize", "mightReturnEarlyFromDoStep", "hasEventMode"), "true"
    )
    fixed = made.options.method == "fixed" and made.options.step
    size = {"fixedInternalStepSize": repr(float(made.options.step))} if fixed else {}
    rates = DERIVES_THREE | {"maxOutputDerivativeOrder": "1"} if _has_rates(made) else {}
    SubElement(root, "CoSimulation", common | able | size | rates)


class Display(NamedTuple):
    """A unit for display: what is shown is factor times the value, plus an offset."""

    name: str
    factor: float
    offset: float = 0.0


DISPLAY = {
    "rad/s": Display("rpm", 30.0 / pi),
    "rad": Display("deg", 180.0 / pi),
    "Pa": Display("bar", 1e-5),
    "K": Display("degC", 1.0, -273.15),
}


def add_units(root: Element, units: Iterable[str]) -> None:
    """Add the definitions of units."""
    definitions = SubElement(root, "UnitDefinitions")
    for unit in sorted(set(units)):
        made = SubElement(definitions, "Unit", name=unit)
        powers = {base: str(power) for base, power in zip(BASES, powers_of(unit), strict=True) if power}
        SubElement(made, "BaseUnit", powers)
        if unit in DISPLAY:
            shown = DISPLAY[unit]
            offset = {"offset": repr(shown.offset)} if shown.offset else {}
            SubElement(made, "DisplayUnit", {"name": shown.name, "factor": repr(shown.factor)} | offset)


def unit_attributes(unit: str) -> dict[str, str]:
    """What a variable says of its unit."""
    shown = {"displayUnit": DISPLAY[unit].name} if unit in DISPLAY else {}
    return {"unit": unit, **shown}
