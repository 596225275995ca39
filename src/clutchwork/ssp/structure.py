"""SystemStructure.ssd and the parameters of a package, in SSP 1.0."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from clutchwork.declare.units import parse
from clutchwork.fmu_import.description import INPUT, OUTPUT, Description, FMUVariable

SPACE = "http://ssp-standard.org/SSP1/SystemStructure"
SPACES = {"ssc": f"{SPACE}Common", "ssd": f"{SPACE}Description", "ssv": f"{SPACE}ParameterValues"}
VERSION = "1.0"
PARAMETERS = "resources/parameters.ssv"
# in the order of the powers of declare.units
BASES = ("kg", "m", "s", "rad", "K", "A")
FMU_TYPE = "application/x-fmu-sharedlibrary"


class Connector(NamedTuple):
    """An end of a connection: an FMU and one of its variables."""

    element: str
    connector: str


class ParameterValue(NamedTuple):
    """A value of a parameter of an FMU."""

    end: Connector
    value: float


class Package(NamedTuple):
    """What a package is made of."""

    name: str
    tool: str
    fmus: Mapping[str, Description]
    connections: Sequence[tuple[Connector, Connector]]
    parameters: Sequence[ParameterValue]
    t_end: float  # s


def structure(made: Package) -> bytes:
    """SystemStructure.ssd."""
    root = _root("ssd:SystemStructureDescription", made.name, made.tool, "ssc", "ssd")
    system = SubElement(root, "ssd:System", name=made.name)
    if made.parameters:
        bindings = SubElement(system, "ssd:ParameterBindings")
        SubElement(bindings, "ssd:ParameterBinding", source=PARAMETERS)
    elements = SubElement(system, "ssd:Elements")
    given = {one.end for one in made.parameters}
    for name, fmu in made.fmus.items():
        component = SubElement(elements, "ssd:Component", name=name, type=FMU_TYPE, source=f"resources/{name}.fmu")
        component.set("implementation", "CoSimulation")
        connectors = SubElement(component, "ssd:Connectors")
        for one in fmu.variables.values():
            kind = "parameter" if Connector(name, one.name) in given else one.causality
            if one.type and (kind in (INPUT, OUTPUT) or Connector(name, one.name) in given):
                connector = SubElement(connectors, "ssd:Connector", name=one.name, kind=kind)
                SubElement(connector, f"ssc:{one.type}", _unit(one))
    if made.connections:
        connections = SubElement(system, "ssd:Connections")
        for start, end in made.connections:
            SubElement(
                connections,
                "ssd:Connection",
                startElement=start.element,
                startConnector=start.connector,
                endElement=end.element,
                endConnector=end.connector,
            )
    _add_units(SubElement(root, "ssd:Units"), (one for fmu in made.fmus.values() for one in fmu.variables.values()))
    SubElement(root, "ssd:DefaultExperiment", startTime="0.0", stopTime=repr(made.t_end))
    return _text(root)


def parameter_set(made: Package) -> bytes:
    """The values of parameters, by the names of FMU and variable."""
    root = _root("ssv:ParameterSet", f"parameters of {made.name}", made.tool, "ssc", "ssv")
    values = SubElement(root, "ssv:Parameters")
    variables = [made.fmus[one.end.element].variables[one.end.connector] for one in made.parameters]
    for (end, value), variable in zip(made.parameters, variables, strict=True):
        parameter = SubElement(values, "ssv:Parameter", name=f"{end.element}.{end.connector}")
        SubElement(parameter, f"ssv:{variable.type}", {"value": _number(variable, value), **_unit(variable)})
    _add_units(SubElement(root, "ssv:Units"), variables)
    return _text(root)


def powers(one: FMUVariable) -> tuple[int, ...] | None:
    """Powers of the unit of a variable, None where it has none that is known."""
    try:
        return parse(one.unit).powers if one.unit else None
    except ValueError:
        return None


def _number(one: FMUVariable, value: float) -> str:
    if one.type == "Boolean":
        return "true" if value > 0.5 else "false"
    return repr(float(value)) if one.type == "Real" else str(round(value))


def _unit(one: FMUVariable) -> dict[str, str]:
    return {"unit": one.unit} if one.type == "Real" and powers(one) is not None else {}


def _add_units(units: Element, variables: Iterable[FMUVariable]) -> None:
    known = {one.unit: one for one in variables if _unit(one)}
    for name, one in sorted(known.items()):
        unit = SubElement(units, "ssc:Unit", name=name)
        base = {key: str(power) for key, power in zip(BASES, powers(one) or (), strict=True) if power}
        scale = {"factor": one.scale.factor, "offset": one.scale.zero}
        base |= {key: repr(value) for key, value in scale.items() if value != (key == "factor")}
        SubElement(unit, "ssc:BaseUnit", base)


def _root(tag: str, name: str, tool: str, *spaces: str) -> Element:
    root = Element(tag, {f"xmlns:{space}": SPACES[space] for space in spaces})
    root.set("version", VERSION)
    root.set("name", name)
    root.set("generationTool", tool)
    return root


def _text(root: Element) -> bytes:
    indent(root)
    text: bytes = tostring(root, encoding="utf-8")
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + text + b"\n"
