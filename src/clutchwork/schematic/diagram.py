"""What is in a schematic: nodes, elements, and who is attached to whom; models with mistakes included."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field
from numbers import Real
from typing import Any, NamedTuple

from clutchwork.base import dataclass
from clutchwork.base.quote import printable, shortened
from clutchwork.declare.node import Component, HeatFlow, Node, Rate, SupplyPower, ThermalNode
from clutchwork.declare.schema import Role, inputs, specs
from clutchwork.model.components import component_problems
from clutchwork.model.model import Model
from clutchwork.model.parts import take_apart

LONGEST, TITLE = 28, 80  # letters of a name, and of that of the driveline


@dataclass(frozen=True, eq=False)
class Thing:
    """One symbol: a node or an element."""

    name: str
    what: str  # shaft, mass, thermal, ambient, oil, missing, element, heat
    source: Any  # the node or element itself
    pins: dict[str, Thing] = field(default_factory=dict)  # of an element: port -> node
    fixed: frozenset[str] = frozenset()  # ports at the housing, or at the sump
    helpers: list[Thing] = field(default_factory=list)  # processes that drive it
    inner: list[str] = field(default_factory=list)  # names of pins at shafts inside of it

    @property
    def is_node(self) -> bool:
        """Whether elements are attached to it."""
        return self.what not in ("element", "heat")

    @property
    def nodes(self) -> list[Thing]:
        """The nodes that it is attached to, each once."""
        return list(dict.fromkeys(self.pins.values()))


@dataclass(frozen=True, eq=False)
class SymbolGraph:
    """All symbols of a driveline, in order."""

    name: str
    things: list[Thing]

    @property
    def nodes(self) -> list[Thing]:
        """Shafts, masses, thermal nodes, and those that are missing."""
        return [thing for thing in self.things if thing.is_node]

    @property
    def elements(self) -> list[Thing]:
        """What is attached to them."""
        return [thing for thing in self.things if not thing.is_node]


def label(name: object, longest: int = LONGEST) -> str:
    """A name as it is written in the picture."""
    text = shortened(printable(name if isinstance(name, str) else str(name)), longest)
    return text if text.strip() else "?"


def diagram(model: Model) -> SymbolGraph:
    """The diagram of a model, whatever its mistakes."""
    return _GraphBuilder(model).read()


class _GraphBuilder:
    """Finds the node of each port, and makes one for those that are missing."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._nodes: dict[object, Thing] = {}
        self._missing: dict[object, Thing] = {}
        self._heats: list[Thing] = []
        self._inner: dict[str, str] = {}  # shafts inside of composites, and who has them

    def read(self) -> SymbolGraph:
        """Everything of the model."""
        model = self._model
        for node in model.nodes:
            self._nodes[id(node)] = Thing(label(node.name), _sort(node), node)
        for thermal in model.thermal:
            self._thermal(thermal)
        oil = [component for component in model.elements if type(component).gathers]
        self._nodes |= {id(component): Thing(label(component.name), "oil", component) for component in oil}
        others = [component for component in model.elements if not type(component).gathers]
        insides = [_inside(component) for component in others]
        for component, inside in zip(others, insides, strict=True):
            self._inner |= dict.fromkeys((node.name for node in inside.nodes), component.name)
        elements = [self._element(*pair) for pair in zip(others, insides, strict=True)]
        self._join(elements)
        placed = _assisted(elements)
        found = [thing for thing in elements if id(thing) not in placed]
        nodes = [*self._nodes.values(), *self._missing.values()]
        return SymbolGraph(label(model.name, TITLE), list(dict.fromkeys([*nodes, *found, *self._heats])))

    def _thermal(self, node: ThermalNode) -> Thing:
        what = "ambient" if node.capacity is None else "thermal"
        return self._nodes.setdefault(("heat", str(node.name)), Thing(label(node.name), what, node))

    def _element(self, component: Component, inside: Inside) -> Thing:
        pins: dict[str, Thing] = {}
        fixed = []
        for item, spec in specs(type(component), "port"):
            node = getattr(component, item.name, None)
            if (node is None and spec.optional) or (isinstance(node, Node) and node.fixed):
                fixed.append(item.name)
            else:
                pins[item.name] = self._node(node)
        # a plate of several nodes is drawn as one
        plain = not specs(type(component), "port", "thermal") and not inside.nodes
        whole = plain and component.role is Role.COMPOSITE and bool(inside.thermal)
        thing = Thing(
            label(component.name),
            "thermal" if whole else "element",
            component,
            pins,
            frozenset(fixed) | _sumps(component),
        )
        for node in inside.thermal:
            key = ("heat", str(node.name))
            if whole:
                self._nodes[key] = thing
            else:
                self._thermal(node)
        if component.role is Role.FLOW:
            for item, _ in specs(type(component), "thermal"):
                pins[item.name] = self._heat_node(getattr(component, item.name, None))
        for item, spec in specs(type(component), "signal"):
            value = getattr(component, item.name, None)
            if spec.draws and isinstance(value, Component) and type(value).gathers:
                pins[item.name] = self._node(value)
        for node in inside.heated:
            self._heats.append(Thing(thing.name, "heat", component, {"heat": self._heat_node(node)}))
        return thing

    def _node(self, node: object) -> Thing:
        named = isinstance(node, (Node, Component))
        if named and id(node) in self._nodes:
            return self._nodes[id(node)]
        if isinstance(node, Node) and node.name in self._inner:
            return self._nodes.setdefault(node.name, Thing(label(node.name), _sort(node), node))
        key = id(node) if named else ("none", str(node))
        name = node.name if isinstance(node, (Node, Component)) else node
        return self._missing.setdefault(key, Thing(label("?" if name is None else name), "missing", node))

    def _join(self, elements: list[Thing]) -> None:
        """Join a shaft inside of a composite, which something else is attached to, to the symbol of that."""
        wholes = {thing.source.name: thing for thing in elements}
        for name, whole in self._inner.items():
            if name in self._nodes:
                inner = name.removeprefix(f"{whole}.")
                wholes[whole].pins[inner] = self._nodes[name]
                wholes[whole].inner.append(inner)

    def _heat_node(self, node: object) -> Thing:
        if isinstance(node, ThermalNode):
            found = self._nodes.get(("heat", str(node.name)))
            if found is not None:
                return found
        name = node.name if isinstance(node, ThermalNode) else node
        key = ("heat", str(name))
        return self._missing.setdefault(key, Thing(label("?" if name is None else name), "missing", node))


def _sort(node: Node) -> str:
    return "mass" if getattr(node.domain, "value", "") == "translation" else "shaft"


class Inside(NamedTuple):
    """Nodes that an element is made of, and thermal nodes that take its heat."""

    nodes: tuple[Node, ...]
    thermal: tuple[ThermalNode, ...]
    heated: tuple[ThermalNode, ...]


def _inside(component: Component) -> Inside:
    """What is inside of an element; nothing where it has mistakes."""
    if any(component_problems(component)):
        node = getattr(component, "heat", None)
        return Inside((), (), (node,) if isinstance(node, ThermalNode) else ())
    parts = take_apart([component])
    paths = [part.heat_path() for part in parts.components]
    named = {path.node.name: path.node for path in paths if path is not None}
    return Inside(parts.nodes, parts.thermal, tuple(named.values()))


def _assisted(elements: list[Thing]) -> set[int]:
    """Give each process to the first element that it drives; those that found a place, by identity."""
    of = {id(thing.source): thing for thing in elements}
    placed: set[int] = set()
    for thing in elements:
        for source in given_by(thing.source):
            helper = of.get(id(source))
            if helper is None or helper is thing or id(helper) in placed or source.role is not Role.PROCESS:
                continue
            # one that drives itself in a circle stays on its own, and so does oil that has no room beside its line
            if not _drives(thing, helper) and (not helper.pins or _has_room(thing, helper)):
                thing.helpers.append(helper)
                thing.pins.update({f"{helper.name}.{port}": node for port, node in helper.pins.items()})
                placed.add(id(helper))
    return placed


def _has_room(thing: Thing, helper: Thing) -> bool:
    """Whether the line of a piston gets to it above what it presses."""
    alone = not any(one.pins for one in thing.helpers)
    return alone and len(helper.pins) == 1 and thing.source.role is not Role.PROCESS


def _oil_ports(component: Component) -> list[str]:
    """Ports for oil, in the order in which it is meant to flow."""
    return [item.name for item, spec in specs(type(component), "signal") if spec.draws]


def first_oil_port(component: Component) -> str:
    """Where oil is meant to come in; empty if there is no port."""
    return next(iter(_oil_ports(component)), "")


def _sumps(component: Component) -> frozenset[str]:
    """Ports for oil at the pressure around."""
    values = ((name, getattr(component, name, None)) for name in _oil_ports(component))
    return frozenset(name for name, value in values if isinstance(value, Real) and value == 0)


def _drives(helper: Thing, thing: Thing) -> bool:
    return helper is thing or any(_drives(helper, inner) for inner in thing.helpers)


def given_by(element: Any) -> Iterator[Component]:
    """Components whose states are inputs of an element."""
    for names, _ in inputs(type(element)):
        for name in names:
            value = getattr(element, name, None)
            value = value[0] if isinstance(value, tuple) and value else value
            if isinstance(value, Component):
                yield value


def referred(value: object) -> str:
    """An input that something else of the model gives, in words; empty for any other."""
    if isinstance(value, Rate):
        return f"slip of {label(value.of.name)}"
    if isinstance(value, HeatFlow):
        return f"heat of {label(value.of.name)}"
    if isinstance(value, SupplyPower):
        return f"supply of {label(value.of.name)}"
    if isinstance(value, Node):
        return f"speed of {label(value.name)}"
    if isinstance(value, ThermalNode):
        return f"{label(value.name)}"
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], Component):
        return f"{label(value[0].name)}.{value[1]}"
    return label(value.name) if isinstance(value, Component) else ""
