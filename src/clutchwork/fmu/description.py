"""modelDescription.xml of an FMU, in FMI 2.0 or 3.0."""

from __future__ import annotations

import re
from math import isfinite
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from clutchwork.base.bounds import plain
from clutchwork.fmu.interface import Interface
from clutchwork.fmu.units import add_units, unit_attributes
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
        root.set("numberOfEventIndicators", "0")
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
    return {"causality": "output", "variability": variability, "initial": "calculated"}


def _number(one: FmuVariable) -> dict[str, str]:
    """Unit, bounds and start."""
    if one.kind is VariableKind.MODE:
        return {"min": "-1", "max": "2"}
    bounds = {
        name: repr(value) for name, value in zip(("min", "max"), plain(one.bounds), strict=True) if isfinite(value)
    }
    given = one.kind in (VariableKind.INPUT, VariableKind.SLOPE, VariableKind.TUNABLE, VariableKind.FIXED)
    return unit_attributes(one.unit) | bounds | ({"start": repr(one.start)} if given else {})


def _dependencies(one: FmuVariable, is_output: bool) -> dict[str, str]:
    """What an output that follows from states says: importers then see no algebraic loop."""
    return {"dependencies": ""} if one.follows_states and is_output else {}


def _units(made: Interface) -> list[str]:
    return [one.unit for one in made.variables if one.kind is not VariableKind.MODE]


# ------------------------------------------------------------------------------------------------------------- FMI 2.0


def _add_two(root: Element, made: Interface, identifier: str) -> None:
    SubElement(
        root,
        "CoSimulation",
        modelIdentifier=identifier,
        canHandleVariableCommunicationStepSize="true",
        canInterpolateInputs="true",
        maxOutputDerivativeOrder="0",
        canNotUseMemoryManagementFunctions="true",
        canGetAndSetFMUstate="true",
        canSerializeFMUstate="true",
    )
    add_units(root, _units(made))
    _categories(root)
    _experiment(root, made)
    listed = [
        (n, one) for n, one in enumerate(made.variables) if one.kind not in (VariableKind.TIME, VariableKind.SLOPE)
    ]
    variables = SubElement(root, "ModelVariables")
    for number, one in listed:
        scalar = SubElement(variables, "ScalarVariable", _common(one, number) | _role(one))
        SubElement(scalar, "Integer" if one.kind is VariableKind.MODE else "Real", _number(one))
    structure = SubElement(root, "ModelStructure")
    for part in ("Outputs", "InitialUnknowns"):
        if not made.of(VariableKind.SIGNAL, VariableKind.MODE):
            break
        unknowns = SubElement(structure, part)
        for index, (_, one) in enumerate(listed, start=1):
            if one.kind in (VariableKind.SIGNAL, VariableKind.MODE):
                SubElement(unknowns, "Unknown", {"index": str(index)} | _dependencies(one, part == "Outputs"))


# ------------------------------------------------------------------------------------------------------------- FMI 3.0


def _add_three(root: Element, made: Interface, identifier: str) -> None:
    SubElement(
        root,
        "CoSimulation",
        modelIdentifier=identifier,
        canHandleVariableCommunicationStepSize="true",
        mightReturnEarlyFromDoStep="true",
        canGetAndSetFMUState="true",
        canSerializeFMUState="true",
        hasEventMode="true",
    )
    if made.options.method == "fixed" and made.options.step:
        root[0].set("fixedInternalStepSize", repr(float(made.options.step)))
    add_units(root, _units(made))
    _categories(root)
    _experiment(root, made)
    variables = SubElement(root, "ModelVariables")
    for number, one in enumerate(made.variables):
        of = {"derivative": str(one.of)} if one.kind is VariableKind.SLOPE else {}
        kind = "Int32" if one.kind is VariableKind.MODE else "Float64"
        SubElement(variables, kind, _common(one, number) | _role(one) | _number(one) | of)
    structure = SubElement(root, "ModelStructure")
    for part in ("Output", "InitialUnknown"):
        for number, one in made.of(VariableKind.SIGNAL, VariableKind.MODE):
            SubElement(structure, part, {"valueReference": str(number)} | _dependencies(one, part == "Output"))
