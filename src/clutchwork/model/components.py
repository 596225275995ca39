"""Checks of single elements: their values, what they ask of their law, and what they join."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf, isfinite
from numbers import Real
from typing import Any

from clutchwork.base import Problem, listed, near, quote
from clutchwork.declare.node import Component, Domain, Entry, Law, Node, ThermalNode
from clutchwork.declare.ports import directions, ports
from clutchwork.declare.schema import REGISTRY, Role, specs
from clutchwork.declare.wording import path_of
from clutchwork.model.fields import is_sound, object_problems
from clutchwork.model.numbers import At
from clutchwork.model.thermal import Within

SLIPS = {Domain.ROTATION: "rad/s", Domain.TRANSLATION: "m/s"}


def component_problems(component: Component, at: At | None = None, *, sound: bool = False) -> Iterator[Problem]:
    """All mistakes of one element, its friction law, its signals and the elements that its tables describe.

    Parameters: at, its place where it is not one of its own; sound, whether its values are known to be right.
    """
    at = at or At(path_of(component), "")
    found = list(object_problems(component, at, sound=sound))
    # rules between values may be broken, values themselves may not
    entries = component.entries() if not found or sound or is_sound(component) else ()
    found += [problem for entry in entries for problem in _entry_problems(entry, at)]
    found = found or list(_beyond_numbers(component, at))
    yield from found
    yield from locked_problems(component, at)
    # what an element asks of its law is only asked once both make sense
    for name, message, remedy in () if found else component.law_problems():
        yield at.inner(name).problem(message, remedy=remedy)
    yield from () if found else _slip_problems(component, at)


def _slip_units(component: Component) -> set[str]:
    """Units of the slips of an element."""
    return {SLIPS[way.domain] for way in directions(component)}


def _slip_problems(component: Component, at: At) -> Iterator[Problem]:
    """A friction law that is written for the other kind of motion."""
    law = component.friction
    if isinstance(law, Law):
        for unit in _slip_units(component):
            for name, message, remedy in law.slip_problems(unit):
                yield at.inner("friction").inner(name).problem(message, remedy=remedy)


def type_problem(kind: Any, at: At) -> Problem:
    """A kind of an element in a composite that there is not."""
    known = [name for role in (Role.CONTACT, Role.COMPOSITE) for name, cls in REGISTRY[role].items() if _joins_two(cls)]
    meant = near(kind, [*known, *REGISTRY[Role.TORQUE]])
    remedy = "" if meant else f"known types: {listed(known)}"
    return at.inner("type").problem(f"is an unknown type{meant}", quote(kind), remedy)


def _joins_two(cls: Any) -> bool:
    """Whether an element is one between two shafts, with friction."""
    names = {item.name for item, _ in specs(cls)}
    return "friction" in names and ({"base", "follower"} <= names or "shaft" in names)


def _entry_problems(entry: Entry, owner: At) -> Iterator[Problem]:
    """Mistakes of an element that a table of a composite describes."""
    at = owner.inner(entry.quantity)
    if entry.cls is None:
        yield type_problem(entry.kind, at)
    elif entry.made is None:
        yield at.inner("type").problem(entry.fault[0], quote(entry.kind), entry.fault[1])
    else:
        known = [item.name for item, spec in specs(entry.cls) if spec.what != "port"]
        for key in entry.unknown:
            meant = near(key, known)
            remedy = "" if meant else f"known keys: {listed(known)}"
            yield at.inner(key).problem(f"is an unknown key{meant}", remedy=remedy)
        yield from component_problems(entry.made, at)


def _beyond_numbers(component: Component, at: At) -> Iterator[Problem]:
    """Values that are allowed one by one, and from which nothing can be computed."""
    try:
        for part in component.parts():
            if isinstance(part, Component):
                yield from _beyond_numbers(part, at) if part.name != component.name else ()
            elif not _sensible(part):
                raise OverflowError
        starts, scales = component.initial_states(), component.state_scales()
        if not all(map(isfinite, (*starts, *scales))) or 0.0 in scales:
            raise OverflowError
    except ArithmeticError:
        yield at.problem(
            "has values too large or too small to compute with", remedy="correct the values of unusual magnitude"
        )


def _sensible(node: Node | ThermalNode) -> bool:
    """Whether the numbers of a node inside of a composite can be computed with."""
    if isinstance(node, ThermalNode):
        return node.capacity is None or 0.0 < node.capacity < inf
    return 0.0 <= node.inertia < inf and isfinite(node.speed or 0.0) and isfinite(node.angle or 0.0)


def locked_problems(contact: Any, at: At) -> Iterator[Problem]:
    """A contact that starts locked with a law that never locks; a freewheel locks by itself."""
    law = contact.friction
    if isinstance(law, Law) and not law.sticks and not contact.one_way and contact.locked:
        known: Any = REGISTRY[Role.LAW]
        sticking = ", ".join(kind for kind in known if known[kind].sticks)
        remedy = f"remove it, or use a law that sticks: {sticking}"
        yield at.inner("locked").problem("cannot hold with a law that never locks", value="True", remedy=remedy)


def component_advice(component: Component) -> Iterator[Problem]:
    """What an element and its friction law allow and is rarely wanted."""
    yield from _law_advice(component)
    for entry in component.entries():
        yield from component_advice(entry.made) if entry.made is not None else ()


def _law_advice(component: Component) -> Iterator[Problem]:
    """What the friction law of an element allows and is rarely wanted; nothing where the law has mistakes."""
    law, place = component.friction, At(path_of(component), "friction")
    if not isinstance(law, Law) or any(object_problems(law, place)):
        return
    units = {item.name: spec.unit for item, spec in specs(type(law))}
    try:
        found = [*law.advice(), *(one for unit in _slip_units(component) for one in law.slip_advice(unit))]
    except ArithmeticError:
        yield place.problem(
            "has values too large or too small to compute with", remedy="correct the values of unusual magnitude"
        )
        return
    for name, message, remedy in found:
        given = getattr(law, name)
        # a table is shown by what is said of it
        value = f"{given:g} {units[name]}".removesuffix(" 1") if isinstance(given, Real) else ""
        yield place.inner(name).problem(message, value=value, remedy=remedy)


def _one_shaft(moving: Mapping[str, Node], within: Within, at: At) -> Iterator[Problem]:
    """Two ports on one shaft, between which nothing acts."""
    seen = dict[Any, str]()
    for name, node in moving.items():
        # nodes inside of a composite are made anew
        first = seen.setdefault(node.name if within.holds(node) else id(node), name)
        if first != name:
            yield at.problem(
                f"{first} and {name} are both attached to {quote(node.name)}", remedy="attach them to two shafts"
            )
            return


def connection_problems(component: Component, nodes: Mapping[int, Node], within: Within) -> Iterator[Problem]:
    """Ports that are on foreign nodes, on one and the same node, or of two kinds of motion; `nodes` by identity."""
    joined = ports(component)
    if not joined or not all(isinstance(node, Node) for node in joined.values()):
        return
    moving = {name: node for name, node in joined.items() if not node.fixed}
    at = At(path_of(component), "")
    for name, node in moving.items():
        if id(node) in nodes:
            continue
        if any(node.name == other.name for other in nodes.values()) or not within.holds(node):
            found = near(node.name, [n.name for n in nodes.values() if n.name != node.name])
            yield at.inner(name).problem("belongs to another driveline", quote(node.name), f"create it here{found}")
    if not moving:
        yield at.problem("is attached to the housing alone", remedy="attach a port to a shaft")
    # members of a planetary gear on one shaft lock it
    elif "carrier" not in joined:
        yield from _one_shaft(moving, within, at)
    if len({node.domain for node in moving.values()}) < 2:
        return
    free = [item.name for item, spec in specs(type(component), "port") if not spec.domain]
    if len({moving[name].domain for name in free if name in moving}) > 1:
        kinds = ", ".join(f"{name} is in {moving[name].domain.value}" for name in free if name in moving)
        yield at.problem(f"connects a shaft and a mass: {kinds}", remedy="put a `RollingWheel` between them")
