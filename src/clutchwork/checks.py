"""Checks of single components against their declarations: types, bounds, curves, friction laws.

What concerns the driveline as a whole is in `assemble.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import MISSING
from math import inf, isfinite
from numbers import Real
from typing import Any

from clutchwork.errors import Problem, near
from clutchwork.node import Component, Domain, Law, Node, Signal, ThermalNode, is_reference
from clutchwork.number_checks import At as At
from clutchwork.number_checks import curve_problems, list_problems
from clutchwork.number_checks import number_problems as number_problems
from clutchwork.schema import Role, Spec, inputs, specs
from clutchwork.shown import shown
from clutchwork.speech import kinds_of, path_of, say


class Broken:
    """Stands for a value whose mistake has been reported already."""


BROKEN = Broken()


def label(component: Component) -> str:
    """Path of an element in messages."""
    return path_of(component)


def component_problems(component: Component) -> Iterator[Problem]:
    """All mistakes of one element, its friction law and its signals."""
    at = At(label(component), "")
    found = list(object_problems(component, at))
    found = found or list(_beyond_numbers(component, at))
    yield from found
    if hasattr(component, "friction"):
        from clutchwork.law_checks import locked_problems

        yield from locked_problems(component, at)
    # what an element asks of its law is only asked once both make sense
    if hasattr(component, "law_problems") and not found:
        for name, message, remedy in component.law_problems():
            yield at.inner(name).problem(message, remedy=remedy)


def _beyond_numbers(component: Any, at: At) -> Iterator[Problem]:
    """Values that are allowed one by one, and from which nothing can be computed."""
    try:
        for part in component.parts():
            yield from _beyond_numbers(part, at) if isinstance(part, Component) and part.name != component.name else ()
            capacity = getattr(part, "capacity", None)
            if capacity is not None and not 0.0 < capacity < inf:
                raise OverflowError
        if hasattr(component, "initial_states"):
            starts, scales = component.initial_states(), component.state_scales()
            if not all(map(isfinite, (*starts, *scales))) or 0.0 in scales:
                raise OverflowError
    except ArithmeticError:
        yield at.problem("has values from which no number can be computed", remedy="correct those of unusual size")


def object_problems(thing: Any, at: At) -> Iterator[Problem]:
    """All mistakes of a declared object: an element, a law or a signal."""
    found = list(value_problems(type(thing), vars(thing), at))
    yield from found
    # rules between fields only make sense once each field does; what is wrong inside a law is its own affair
    inside = tuple(f"{at.inner(item.name).quantity}." for item, _ in specs(type(thing), "law"))
    rules = getattr(thing, "problems", None)
    if rules is not None and all(problem.quantity.startswith(inside) for problem in found):
        try:
            for name, message, remedy in rules():
                yield at.inner(name).problem(message, remedy=remedy)
        except ArithmeticError:
            yield at.problem("has values from which no number can be computed", remedy="correct those of unusual size")


def value_problems(cls: type, values: Mapping[str, Any], at: At) -> Iterator[Problem]:
    """Mistakes of the values for the fields of a declaration, some of which may be missing."""
    for item, spec in specs(cls):
        place = at.inner(item.name, at.unit if spec.unit == "*" else spec.unit)
        value = values.get(item.name, item.default)
        if value is MISSING:
            yield place.problem("is missing", remedy=f"give {wanted(spec, place.unit)}: {spec.doc}")
        elif value is not BROKEN and not (value is None and spec.optional):
            yield from CHECKS[spec.what](value, spec, place)
    yield from _choice_problems(cls, values, at)


def wanted(spec: Spec, unit: str) -> str:
    """What a field asks for, in words."""
    if spec.choices:
        return f"one of {', '.join(spec.choices)}"
    return {
        "port": "a shaft",
        "thermal": "a thermal node",
        "law": f"a friction law ({kinds_of(Role.LAW)})",
        "curve": f"points in [{spec.unit_x}] and [{unit}]",
        "numbers": f"a list of numbers in [{unit}]",
        "text": "a text",
    }.get(spec.what, f"a value in [{unit}]")


def _choice_problems(cls: type, values: Mapping[str, Any], at: At) -> Iterator[Problem]:
    """Signals that can be given in one of several ways: exactly one, or none where there is a default."""
    for names, spec in inputs(cls):
        given = [name for name in names if values.get(name) is not None]
        if len(names) > 1 and len(given) > 1:
            yield at.inner(given[1]).problem(f"is given beside {given[0]!r}", remedy="give only one of them")
        if len(names) > 1 and not given and spec.otherwise is None:
            choice = " or ".join(names)
            yield at.inner(names[0]).problem("is missing", remedy=f"give {choice}: {spec.doc} [{spec.unit}]")


def _param(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if spec.choices:
        if value not in spec.choices:
            message = "is not known" + near(value, spec.choices)
            yield at.problem(message, value=shown(value), remedy=f"known are {', '.join(spec.choices)}")
    elif not spec.flag:
        yield from number_problems(value, spec, at)
    elif not isinstance(value, bool) and value not in (0, 1):
        yield at.problem("must be true or false", value=shown(value), remedy=spec.doc)


def _port(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if not isinstance(value, Node):
        in_python = "pass the object returned by d.shaft(...), d.mass(...) or d.housing"
        remedy = say("give the name of one", in_python)
        yield at.problem("must be a shaft, a mass or the housing", value=shown(value), remedy=remedy)
    elif spec.domain and not value.fixed and value.domain is not Domain(spec.domain):
        wanted = "a shaft" if spec.domain == "rotation" else "a mass"
        yield at.problem(f"must be {wanted}", value=shown(value.name), remedy=f"{spec.doc} is in {spec.domain}")


def _thermal(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if not isinstance(value, ThermalNode):
        in_python = f"pass the object returned by d.thermal(...) or d.ambient(...): {spec.doc}"
        remedy = say(f"give the name of one: {spec.doc}", in_python)
        yield at.problem("must be a thermal node or an ambient", value=_shown(value), remedy=remedy)


def _shown(value: Any) -> str:
    return shown(value.name if isinstance(value, Node | Component) else value)


def _signal(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if isinstance(value, Signal):
        found = list(object_problems(value, at))
        yield from found
        for name, message, remedy in () if found else value.unit_problems((at.unit, *spec.units)):
            yield at.inner(name).problem(message, remedy=remedy)
    elif isinstance(value, Real) and not isinstance(value, bool):
        yield from number_problems(value, spec, at)
    # whether a reference leads to something of that unit is checked where the driveline is known
    elif not is_reference(value):
        remedy = f"give one of {kinds_of(Role.SIGNAL)}"
        if isinstance(value, list | tuple) and value and all(isinstance(pair, list | tuple) for pair in value):
            remedy = say('write {type = "table", points = [[time, value], ...]}', "wrap it: cw.Table([...])")
        if callable(value):
            remedy = "a function is a controller: give cw.Sampled(function, period), with the period in s"
        yield at.problem(f"must be a number in [{at.unit}] or a signal", value=shown(value), remedy=remedy)


def _law(value: Any, _: Spec, at: At) -> Iterator[Problem]:
    if not isinstance(value, Law):
        remedy = f"give one of {kinds_of(Role.LAW)}"
        yield at.problem("must be a friction law", value=shown(value), remedy=remedy)
        return
    from clutchwork.law_checks import law_problems

    yield from law_problems(value, at)


def _text(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if not isinstance(value, str) or not value:
        yield at.problem("must be a text", value=shown(value), remedy=spec.doc)


def _function(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if not callable(value):
        yield at.problem("must be a Python function", value=shown(value), remedy=spec.doc)


CHECKS: dict[str, Callable[[Any, Spec, At], Iterator[Problem]]] = {
    "param": _param,
    "option": _param,
    "port": _port,
    "thermal": _thermal,
    "curve": curve_problems,
    "numbers": list_problems,
    "signal": _signal,
    "alternative": _signal,
    "law": _law,
    "text": _text,
    "function": _function,
}


def ports(component: Component) -> dict[str, Node]:
    """Nodes at the ports of an element; an optional port that is not given is the housing."""
    from clutchwork.node import HOUSING

    return {item.name: getattr(component, item.name) or HOUSING for item, _ in specs(type(component), "port")}


def thermal_ports(component: Component) -> dict[str, ThermalNode]:
    """Thermal nodes at the ports of an element, those that are given."""
    values = {item.name: getattr(component, item.name) for item, _ in specs(type(component), "thermal")}
    return {name: node for name, node in values.items() if node is not None}


def connection_problems(component: Component, nodes: Sequence[Node]) -> Iterator[Problem]:
    """Ports that are on foreign nodes, on one and the same node, or of two kinds of motion."""
    at, joined = At(label(component), ""), ports(component)
    if not joined or not all(isinstance(node, Node) for node in joined.values()):
        return
    known = {id(node) for node in nodes}
    for name, node in joined.items():
        if not node.fixed and id(node) not in known:
            found = near(node.name, [n.name for n in nodes if n.name != node.name])
            yield at.inner(name).problem("is of another driveline", shown(node.name), f"create it in this one{found}")
    moving = {name: node for name, node in joined.items() if not node.fixed}
    if not moving:
        yield at.problem("joins nothing but the housing", remedy="attach a port to a shaft")
    elif len(joined) == 2 and len({id(node) for node in joined.values()}) == 1:
        names = " and ".join(joined)
        yield at.problem(
            f"{names} are both on {shown(next(iter(joined.values())).name)}", remedy="attach them to two shafts"
        )
    free = [name for _item, spec in specs(type(component), "port") if not spec.domain for name in [_item.name]]
    if len({moving[name].domain for name in free if name in moving}) > 1:
        kinds = ", ".join(f"{name} is in {moving[name].domain.value}" for name in free if name in moving)
        yield at.problem(f"joins a shaft and a mass: {kinds}", remedy="put a `RollingWheel` between them")
