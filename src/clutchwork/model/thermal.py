"""Checks of thermal nodes, of the ports on them, and of inputs that other components give."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from clutchwork.base import Problem, dataclass, listed, near, quote
from clutchwork.declare import units
from clutchwork.declare.node import (
    DIRECT,
    Component,
    Domain,
    HeatFlow,
    Node,
    Rate,
    SupplyPower,
    ThermalNode,
    is_reference,
)
from clutchwork.declare.ports import thermal_ports
from clutchwork.declare.quantity import within
from clutchwork.declare.schema import Role, Spec, specs
from clutchwork.declare.wording import path_of
from clutchwork.model.fields import CHECKS
from clutchwork.model.numbers import At, number_problems
from clutchwork.model.parts import Parts, all_parts, role, state_name

CAPACITY = Spec("param", "J/K", "heat capacity", above=0.0)
TEMPERATURE = Spec("param", "K", "temperature at the start", above=0.0)
LIMIT = Spec("param", "K", "highest temperature that it stands", above=0.0)
AROUND = Spec("signal", "K", "temperature over time")
NODE_FIELDS: Mapping[str, Mapping[str, Spec]] = {
    "thermal": {"capacity": CAPACITY, "temperature": TEMPERATURE, "limit": LIMIT},
    "ambient": {"temperature": AROUND},
}


def node_kind(node: ThermalNode) -> str:
    """Key of a thermal node in model files: thermal or ambient."""
    return "ambient" if node.capacity is None else "thermal"


def thermal_problems(node: ThermalNode) -> Iterator[Problem]:
    """Mistakes of one thermal mass or ambient."""
    path = f'{node_kind(node)} "{node.name}"'
    if node.capacity is not None:
        yield from number_problems(node.capacity, CAPACITY, At(path, "capacity", "J/K"))
        yield from number_problems(node.temperature, TEMPERATURE, At(path, "temperature", "K"))
        if node.limit is not None:
            yield from number_problems(node.limit, LIMIT, At(path, "limit", "K"))
    elif is_reference(node.temperature):
        message, remedy = "must be a number in [K] or a signal", "join the nodes by a Conduction instead"
        yield At(path, "temperature").problem(message, quote(node.temperature), remedy)
    else:
        yield from CHECKS["signal"](node.temperature, AROUND, At(path, "temperature", "K"))


@dataclass(frozen=True)
class Within:
    """Nodes that are parts of elements, which are made anew each time they are asked for."""

    names: Collection[str]
    broken: Collection[str]  # elements with mistakes, whose parts are not known

    def holds(self, node: Node | ThermalNode) -> bool:
        """Whether a node is such a part, or may be."""
        return node.name in self.names or any(node.name.startswith(f"{name}.") for name in self.broken)


def port_problems(component: Component, thermal: Sequence[ThermalNode], within: Within) -> Iterator[Problem]:
    """Thermal ports on foreign nodes, or both on one and the same."""
    joined = thermal_ports(component)
    if not joined or not all(isinstance(node, ThermalNode) for node in joined.values()):
        return
    at = At(path_of(component), "")
    own = {id(other) for other in thermal}
    for name, node in joined.items():
        foreign = node.name in {other.name for other in thermal} and id(node) not in own
        if foreign or (id(node) not in own and not within.holds(node)):
            found = near(node.name, [other.name for other in thermal])
            yield at.inner(name).problem("belongs to another driveline", quote(node.name), f"create it here{found}")
    if role(component) is Role.FLOW and len({node.name for node in joined.values()}) < len(joined):
        message = f"{' and '.join(joined)} are both attached to {quote(next(iter(joined.values())).name)}"
        yield at.problem(message, remedy="attach them to two different thermal nodes")


@dataclass(frozen=True)
class Referents:
    """What inputs may refer to, by name."""

    states: Mapping[str, tuple[str, ...]]  # thermal node or "process.state" -> unit
    acting: frozenset[str]  # torque elements and contacts
    supplied: frozenset[str]  # those that draw from a supply
    added: Mapping[int, Any]  # shafts, thermal nodes and elements of the driveline by identity
    parts: Mapping[str, Sequence[Any]]  # what elements are made of by name, made anew each time it is asked for

    @classmethod
    def of(
        cls, nodes: Sequence[Node], thermal: Sequence[ThermalNode], elements: Sequence[Component], parts: Parts
    ) -> Referents:
        """Collect all that a reference in a driveline may lead to."""
        states: dict[str, tuple[str, ...]] = {node.name: ("K",) for node in parts.thermal}
        for process in parts.components:
            if role(process) is Role.PROCESS:
                states |= {f"{process.name}.{s.name}": (s.unit,) for s in type(process).states}
        acting = frozenset(c.name for c in parts.components if role(c) in (Role.TORQUE, Role.CONTACT))
        supplied = frozenset(c.name for c in parts.components if c.name in acting and c.supply)
        added = {id(thing): thing for thing in (*nodes, *thermal, *elements)}
        inner = dict[str, list[Any]]()
        for part in (part for element in elements for part in all_parts(element)):
            inner.setdefault(part.name, []).append(part)
        return cls(states, acting, supplied, added, inner)

    def holds(self, target: Any) -> bool:
        """Whether a shaft, node or element was added itself, or is part of one that was."""
        return id(target) in self.added or target in self.parts.get(target.name, ())


def reference_problems(component: Component, whole: Component, known: Referents) -> Iterator[Problem]:
    """Inputs that other components give: whether those are there, and give what is wanted.

    `whole` is what was written: the component, or the composite that has a part of its own name.
    """
    law = component.friction
    for thing, quantity in ((component, ""), (law, "friction")):
        for item, spec in specs(type(thing), "signal", "alternative") if thing is not None else ():
            value = getattr(thing, item.name)
            if is_reference(value):
                written = whole if hasattr(whole, item.name) else component
                place = At(path_of(written), quantity).inner(item.name, spec.unit)
                yield from _reference(value, spec, place, component, known)
            elif value is None and spec.unit == "K" and law is not None and thing is law and law.reads(item.name):
                yield from _temperature(component, At(path_of(component), quantity).inner(item.name, spec.unit))


def _temperature(component: Component, at: At) -> Iterator[Problem]:
    """A friction law without a temperature takes that of the thermal node of its contact."""
    if component.heat_path() is None and role(component) is Role.CONTACT:
        yield at.problem("is missing", remedy="give a temperature [K], or connect the contact by `heat` to a node")


def _reference(value: Any, spec: Spec, at: At, component: Component, known: Referents) -> Iterator[Problem]:
    if not _may_refer(value, role(component)):
        yield at.problem(f"must be a number{within(at.unit)} or a signal", _words(value), "give one of them")
        return
    missing = _missing(value, known)
    if missing:
        yield at.problem(*missing)
        return
    given = _unit(value, known)
    if all(units.parse(given).powers != units.parse(unit).powers for unit in (spec.unit, *spec.units)):
        remedy = f"give a signal in [{at.unit}]: {spec.doc}"
        yield at.problem(f"must be in [{at.unit}], but {_words(value)} gives [{given}]", remedy=remedy)


def _may_refer(value: Any, to: Role) -> bool:
    """Whether a component may have such an input: torques know speeds of shafts, but no rates of other torques."""
    if isinstance(value, DIRECT):
        return to in (Role.FLOW, Role.PROCESS, Role.COMPOSITE)
    return to is not Role.MOTION


def _missing(value: Any, known: Referents) -> tuple[str, str, str] | None:
    """Message, value and remedy where a reference leads nowhere."""
    direct = isinstance(value, DIRECT)
    target = value.of if direct else value[0] if isinstance(value, tuple) else value
    if not known.holds(target):
        return _foreign(target, value, known)
    if isinstance(target, Node):
        return None
    if direct:
        found = target.name in known.acting
        if found and isinstance(value, SupplyPower) and target.name not in known.supplied:
            return "draws nothing from a supply", _words(value), "give an electric motor"
        return None if found else ("is not a torque element or contact", _words(value), "give one of them")
    if isinstance(target, Component) and role(target) is not Role.PROCESS:
        names = "a signal, a thermal node or a process"
        return "has no output", _words(value), f"give {names}, or its Rate, HeatFlow or SupplyPower"
    if state_name(value) in known.states:
        return None
    own = [name for name in known.states if name.startswith(f"{target.name}.")]
    return (
        f"is an unknown state{near(state_name(value), own)}",
        quote(state_name(value)),
        f"known states: {listed(own)}",
    )


def _foreign(target: Any, value: Any, known: Referents) -> tuple[str, str, str]:
    """A shaft, node or element that is referred to and was not added."""
    if target.name in known.parts or any(thing.name == target.name for thing in known.added.values()):
        remedy = "use the one that was added, or add this one under another name"
        return "is not the one that was added to this driveline under this name", _words(value), remedy
    remedy = (
        "add it with d.add(...) and use the object that this returns"
        if isinstance(target, Component)
        else "create it here"
    )
    return "was not added to this driveline", _words(value), remedy


def _unit(value: Any, known: Referents) -> str:
    if isinstance(value, HeatFlow | SupplyPower):
        return "W"
    target = value.of if isinstance(value, Rate) else value
    if isinstance(target, Node):
        return "rad/s" if target.domain is Domain.ROTATION else "m/s"
    return "rad/s" if isinstance(value, Rate) else known.states[state_name(value)][0]


def _words(value: Any) -> str:
    """A reference in words."""
    if isinstance(value, DIRECT):
        return f"{type(value).__name__} of {quote(value.of.name)}"
    return quote(value[0].name if isinstance(value, tuple) else value.name)
