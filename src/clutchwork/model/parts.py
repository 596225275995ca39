"""Composites taken apart into the elements, shafts and thermal nodes that the assembly works on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from typing import Any

from clutchwork.base import dataclass
from clutchwork.declare.node import HOUSING, Component, Node, Part, Rate, ThermalNode
from clutchwork.declare.ports import ports
from clutchwork.declare.schema import Role, inputs
from clutchwork.elements.bases.stop import Stop
from clutchwork.elements.damper import Damper
from clutchwork.elements.displacement import Displacement


class Sensor(Damper):
    """Gives the speed of a shaft to flows and processes; it has no torque and no signals of its own."""


class StopTravel(Displacement):
    """The position of a stop, which stands among the signals of that."""


@dataclass(frozen=True)
class Parts:
    """What a driveline is made of in the end."""

    components: tuple[Component, ...] = ()
    thermal: tuple[ThermalNode, ...] = ()
    nodes: tuple[Node, ...] = ()  # shafts and masses inside of composites
    # "c1" -> parts whose torque, power, work and heat count as those of "c1"
    sums: Mapping[str, tuple[str, ...]] = field(default_factory=dict)


def take_apart(components: Sequence[Component], thermal: Sequence[ThermalNode] = ()) -> Parts:
    """All elements and nodes, those of composites in their place, and a sensor per shaft that is asked."""
    held = held_positions(components)
    components = [placed(component, held) for component in components] if held else components
    pieces = [piece for component in components for piece in _pieces(component)]
    elements = [piece for piece in pieces if isinstance(piece, Component)]
    nodes = [*thermal, *(piece for piece in pieces if isinstance(piece, ThermalNode))]
    # masses, then ambients, as in model files
    nodes.sort(key=lambda node: node.capacity is None)
    asked = {node.name: node for element in elements for node in _asked(element)}
    sensors = [Sensor(sensor_name(node), base=HOUSING, follower=node, damping=0.0) for node in asked.values()]
    there = {element.name for element in elements}
    wholes = [whole for component in components for whole in _wholes(component)]
    sums = {whole.name: tuple(there.intersection(_full(whole))) for whole in wholes if whole.name in there}
    shafts = tuple(piece for piece in pieces if isinstance(piece, Node))
    return Parts((*elements, *sensors), tuple(nodes), shafts, {name: names for name, names in sums.items() if names})


def held_positions(components: Sequence[Component]) -> dict[int, float]:
    """Where masses start that cranks hold and that have no position of their own, by the identity of the mass [m]."""
    return {id(node): place for one in components for node, place in one.start_positions() if node.angle is None}


def placed(component: Component, held: Mapping[int, float]) -> Component:
    """The same element; a stop on a mass that a crank holds has the position that follows."""
    if not is_open(component):
        return component
    joined = [ports(component)[name] for name in ("base", "follower")]
    if held.keys().isdisjoint(map(id, joined)):
        return component
    base, follower = (held.get(id(node), float(node.angle or 0.0)) for node in joined)
    return replace(component, initial_position=follower - base)  # type: ignore[call-arg]


def _wholes(component: Component) -> Iterator[Component]:
    """An element and those that are made of parts inside of it."""
    yield component
    for part in component.parts():
        if isinstance(part, Component) and part.name != component.name:
            yield from _wholes(part)


def _full(whole: Component) -> list[str]:
    return [f"{whole.name}.{name}" for name in whole.sums()]


def sensor_name(node: Node) -> str:
    """Name of the sensor on a shaft."""
    return f"{node.name}.speed_sensor"


def _pieces(component: Component) -> Iterator[Part]:
    parts = list(component.parts())
    if not parts and role(component) is not Role.COMPOSITE:
        yield component
    yield from _places(component)
    for part in parts:
        if isinstance(part, Node | ThermalNode):
            yield part
        elif part.name == component.name:
            # the part with the name of the whole is one piece
            yield part
            yield from _places(part) if part is not component else ()
        else:
            yield from _pieces(part)


def all_parts(component: Component) -> Iterator[Part]:
    """All parts of an element, at every level."""
    for part in component.parts():
        yield part
        if isinstance(part, Component) and part.name != component.name:
            yield from all_parts(part)


def _places(component: Component) -> Iterator[StopTravel]:
    """The position of a stop."""
    if is_stop(component):
        joined = ports(component)
        (start,) = component.initial_states()
        yield StopTravel(place_of(component), base=joined["base"], follower=joined["follower"], initial_position=start)


def _asked(element: Component) -> Iterator[Node]:
    """Shafts whose speed is an input of a flow, a process, a torque element or a contact."""
    things = (element, element.friction) if role(element) not in (Role.GEAR, Role.MOTION) else ()
    for thing in things:
        for names, _ in inputs(type(thing)) if thing is not None else ():
            for value in (getattr(thing, name) for name in names):
                node = value.of if isinstance(value, Rate) else value
                if isinstance(node, Node):
                    yield node


def role(component: Any) -> Role:
    """What a component is to the engine."""
    found: Role = type(component).role
    return found


def is_stop(component: Component) -> bool:
    """Whether it is a contact that exists at the ends of a gap alone."""
    return "end" in type(component).hooks


def is_open(component: Component) -> bool:
    """Whether it is a stop whose position may follow from what moves a mass."""
    return isinstance(component, Stop) and component.is_open()


def place_of(stop: Component) -> str:
    """Name of the position of a stop."""
    return f"{stop.name}.place"


def state_name(value: Any) -> str:
    """Name of the shared state that a reference leads to."""
    if isinstance(value, ThermalNode):
        return value.name
    process, state = value if isinstance(value, tuple) else (value, type(value).states[0].name)
    return f"{process.name}.{state}"
