"""The mistakes of what a model is made of: of its nodes, its elements and their names."""

from __future__ import annotations

from collections.abc import Sequence

from clutchwork.base import Problem, quote
from clutchwork.declare.node import HOUSING, Component, Domain, Node, ThermalNode
from clutchwork.declare.ports import ports
from clutchwork.declare.schema import Spec
from clutchwork.declare.wording import path_of, say
from clutchwork.model.components import component_advice, component_problems, connection_problems
from clutchwork.model.model import Model
from clutchwork.model.numbers import At, is_right, number_problems
from clutchwork.model.parts import Parts, held_positions, placed, take_apart
from clutchwork.model.temperatures import temperature_advice
from clutchwork.model.thermal import Referents, Within, node_kind, port_problems, reference_problems, thermal_problems


def part_problems(model: Model, incomplete: Sequence[str] = ()) -> tuple[list[Problem], Parts, list[str]]:
    """All mistakes of single nodes and elements, the parts of the elements without, the nodes at those with.

    Nodes in `incomplete` belong to elements that are not there.
    """
    nodes, elements, thermal = model.nodes, model.elements, model.thermal
    problems = [] if is_name(model.name) else [Problem("driveline", "name", NO_NAME, quote(model.name), GIVE_NAME)]
    problems += [problem for node in nodes for problem in node_problems(node)]
    problems += [problem for node in thermal for problem in thermal_problems(node)]
    parts, found = _parts(elements, thermal)
    inner = {*(node.name for node in parts.nodes), *(node.name for node in parts.thermal)}
    within = Within(inner, {e.name for e in elements if found[id(e)]})
    own = {id(node): node for node in nodes}
    for element in elements:
        found[id(element)] += [*connection_problems(element, own, within), *port_problems(element, thermal, within)]
        problems += found[id(element)]
    broken = [element for element in elements if found[id(element)]]
    sound = _sound([element for element in elements if not found[id(element)]], model) if broken else parts
    problems += name_problems(nodes, elements, sound)
    # what refers to an element with mistakes is looked at once those are mended
    if not broken and not incomplete:
        known = Referents.of(nodes, thermal, elements, sound)
        wholes = {element.name: element for element in elements}
        for part in sound.components:
            problems += reference_problems(part, wholes.get(part.name, part), known)
    return problems, sound, _touched(broken)


def _parts(elements: Sequence[Component], thermal: Sequence[ThermalNode]) -> tuple[Parts, dict[int, list[Problem]]]:
    """The parts of all elements whose values make sense, and the mistakes of the others."""
    found = {id(element): list(component_problems(element)) for element in elements}
    # a stop on a mass that a crank holds is looked at where it is then
    held = held_positions([element for element in elements if not found[id(element)]])
    for element in elements if held else ():
        if (there := placed(element, held)) is not element:
            found[id(element)] = list(component_problems(there))
    return take_apart([element for element in elements if not found[id(element)]], thermal), found


def _sound(elements: Sequence[Component], model: Model) -> Parts:
    """The parts of elements without mistakes; those on shafts inside of others are left out."""
    made = take_apart(elements, model.thermal)
    known = {HOUSING.name, *(node.name for node in (*model.nodes, *made.nodes))}
    there = [element for element in elements if all(node.name in known for node in ports(element).values())]
    return made if len(there) == len(elements) else _sound(there, model)


def model_advice(model: Model) -> list[Problem]:
    """What a model allows and is rarely wanted: the warnings about it."""
    found = [advice for element in model.elements for advice in component_advice(element)]
    return [*found, *temperature_advice(model.elements, model.thermal)]


def _touched(elements: Sequence[Component]) -> list[str]:
    """Names of all nodes at the given elements."""
    return [value.name for element in elements for value in vars(element).values() if isinstance(value, Node)]


NODE_FIELDS = {
    Domain.ROTATION: {
        "inertia": Spec("param", "kg m2", "moment of inertia, zero only where no torque on it jumps", at_least=0.0),
        "speed": Spec("param", "rad/s", "speed at the start", optional=True),
        "angle": Spec("param", "rad", "angle at the start", optional=True),
    },
    Domain.TRANSLATION: {
        "mass": Spec("param", "kg", "mass, zero only where no force on it jumps", at_least=0.0),
        "speed": Spec("param", "m/s", "speed at the start", optional=True),
        "position": Spec("param", "m", "position at the start", optional=True),
    },
}


def node_path(kind: str, name: object) -> str:
    """Path of a node in messages."""
    return f'{kind} "{name}"'


def _sort(node: Node) -> str:
    return "shaft" if node.domain is Domain.ROTATION else "mass"


def node_problems(node: Node) -> list[Problem]:
    """Mistakes of one shaft or mass."""
    path = node_path(_sort(node), node.name)
    values = (node.inertia, node.speed, node.angle)
    problems: list[Problem] = []
    for (name, spec), value in zip(NODE_FIELDS[node.domain].items(), values, strict=True):
        if not (is_right(value, spec) or (value is None and spec.optional)):
            problems += number_problems(value, spec, At(path, name, spec.unit))
    return problems


TOO_FAR_APART = Problem(
    "driveline",
    "",
    "has values that differ too much in magnitude to compute with",
    remedy="correct inertias, ratios, speeds and signals of unusual magnitude",
)
NO_NAME, GIVE_NAME = (
    "must be a printable string",
    "give a name of printable characters on one line, without blanks at its ends",
)
RUN_AGAIN = "if a notebook cell was run again, create the driveline in it with cw.Driveline(...)"
LONGEST_NAME = 200


def is_name(name: object) -> bool:
    """Whether a name can stand in tables, pictures and on a terminal."""
    return isinstance(name, str) and 0 < len(name) <= LONGEST_NAME and name == name.strip() and name.isprintable()


def name_problems(nodes: Sequence[Node], elements: Sequence[Component], parts: Parts) -> list[Problem]:
    """Names that are not printable strings, reserved or given twice, those of parts included."""
    problems, seen = [], {HOUSING.name: "the housing"}
    things = [(f'shaft "{node.name}"', node.name) for node in nodes]
    things += [(node_path(_sort(node), node.name), node.name) for node in parts.nodes]
    things += [(f'{node_kind(node)} "{node.name}"', node.name) for node in parts.thermal]
    things += [(path_of(element), element.name) for element in elements]
    added = {id(element) for element in elements}
    # one part of a composite may have its name
    wholes = {element.name for element in elements} - {part.name for part in parts.components if id(part) in added}
    inner = [part for part in parts.components if id(part) not in added and part.name not in wholes]
    things += [(path_of(part), part.name) for part in inner]
    for path, name in things:
        if not is_name(name):
            problems.append(Problem(path, "name", NO_NAME, quote(name), GIVE_NAME))
        elif name in seen:
            remedy = "choose another name: results are looked up by name"
            if path == seen[name]:
                remedy += say("", f"; {RUN_AGAIN}")
            problems.append(Problem(path, "name", f"is already the name of {seen[name]}", quote(name), remedy))
        else:
            seen[name] = path
    return problems


def no_shaft() -> Problem:
    """A model without nodes."""
    remedy = say("add one: [[shaft]]", 'add one: d.shaft("engine", inertia=0.2)')
    return Problem("driveline", "", "has no shaft", remedy=remedy)
