"""Who is joined to what in a System, as the evaluation of results needs it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.memoize import memoize
from clutchwork.declare.layout import ROW
from clutchwork.declare.node import Component, Domain, Node
from clutchwork.declare.ports import Direction, directions, port_domains, ports
from clutchwork.declare.schema import Role, State
from clutchwork.model.parts import Sensor, StopTravel, is_stop, place_of
from clutchwork.model.structure import NodePlaces

if TYPE_CHECKING:
    from clutchwork.assembly.records import Link
    from clutchwork.assembly.system import System

# state of a thermal node
HEAT = (State("heat", "J", "heat that it holds above the start, or that an ambient took up"),)
HOUSING = -1  # index that stands for the housing, which is no node of the system


@dataclass(frozen=True)
class Branch:
    """A way of a torque element, a contact or a prescribed speed: name, component and direction over the nodes."""

    name: str
    component: Any
    direction: Mapping[int, float]  # node index or HOUSING -> coefficient of its speed in the rate
    domain: Domain
    states: tuple[tuple[str, str, int], ...] = ()  # (name, unit, index among all states), at its first way
    grounded: Mapping[Domain, float] = field(default_factory=dict)  # coefficient of the housing by kind of motion
    number: int = 0  # of the way
    watched: bool = False  # a way without torque

    @property
    def hidden(self) -> bool:
        """Whether it only measures."""
        return self.watched or isinstance(self.component, Sensor | StopTravel)


@dataclass(frozen=True)
class StateOwner:
    """Something without direction that has shared states: name, component, states."""

    name: str
    component: Any
    states: tuple[tuple[str, str, int], ...]  # (name, unit, index among all states)


@dataclass(frozen=True)
class GearRow:
    """One rigid row of a gear: sum of coefficient * speed = 0."""

    name: str
    ports: Mapping[str, tuple[int, float]]  # port -> (node index or HOUSING, coefficient)
    domains: Mapping[str, Domain]  # port -> rotation or translation

    @property
    def is_line(self) -> bool:
        """Whether it is a rigid line between two nodes, which has a torque and a power of its own."""
        return set(self.ports) == {"base", "follower"}


@dataclass(frozen=True)
class Wiring:
    """The connections of a System and where each quantity stands in an output row."""

    nodes: tuple[Node, ...]
    elements: tuple[Branch, ...]
    contacts: tuple[Branch, ...]
    motions: tuple[Branch, ...]
    gears: tuple[GearRow, ...]
    inputs: tuple[tuple[str, str], ...]  # (name, unit)
    columns: Mapping[str, slice]
    thermal: tuple[StateOwner, ...] = ()
    processes: tuple[StateOwner, ...] = ()
    supplies: tuple[Branch, ...] = ()  # elements that draw work and heat from a supply
    flows: tuple[str, ...] = ()
    links: tuple[Link, ...] = ()
    sensors: tuple[Branch, ...] = ()
    sums: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    unused: frozenset[str] = frozenset()  # inputs of unused features
    composites: tuple[Component, ...] = ()  # those with signals of their own

    @cached_property
    def row_size(self) -> int:
        """Numbers in one output row."""
        return max((part.stop for part in self.columns.values()), default=0)

    @cached_property
    def kinds(self) -> tuple[str, ...]:
        """The part of an output row that each of its numbers is in."""
        return tuple(name for name, part in self.columns.items() for _ in range(part.start, part.stop))

    @property
    def lines(self) -> tuple[GearRow, ...]:
        """Rigid lines, whose energy is integrated, in the order of their column."""
        return tuple(row for row in self.gears if row.is_line)

    def spread(self, branches: tuple[Branch, ...]) -> NDArray[np.float64]:
        """Torque on every node per torque of every branch, shape (nodes, branches)."""
        matrix = np.zeros((len(self.nodes), len(branches)))
        for column, branch in enumerate(branches):
            for node, coefficient in branch.direction.items():
                if node != HOUSING:
                    matrix[node, column] += coefficient
        return matrix


@memoize
def wiring(system: System) -> Wiring:
    """The connections of a System, found once."""
    places = NodePlaces(system.nodes)
    gears = [GearRow(row.gear.name, dict(row.ports), _domains(row.gear)) for row in system.gears]
    branches = [_branch(component, way, places) for component, way in _ways((*system.elements, *system.contacts))]
    branches = _with_states(branches)
    return Wiring(
        nodes=system.nodes,
        elements=tuple(branches[: system.counts["elements"]]),
        contacts=tuple(branches[system.counts["elements"] :]),
        motions=tuple(_branch(component, way, places) for component, way in _ways(system.motions)),
        gears=tuple(gears),
        inputs=tuple((item.name, item.unit) for item in system.inputs),
        columns=row_columns(system.counts),
        thermal=tuple(_shared(system, system.thermal)),
        processes=tuple(_shared(system, system.processes)),
        supplies=tuple(branches[place] for place in system.supply_element),
        flows=tuple(flow.name for flow in system.flows),
        links=system.links,
        sensors=tuple(_branch(component, way, places) for component, way in _ways(system.sensors)),
        sums=system.sums,
        unused=frozenset(item.name for item in system.inputs if not item.given),
        composites=_composites(system),
    )


def _composites(system: System) -> tuple[Component, ...]:
    """Elements of the model that follow from states of their parts."""
    elements = () if system.source is None else system.source.elements
    return tuple(one for one in elements if one.role is Role.COMPOSITE and one.state_sums())


def _shared(system: System, components: tuple[Any, ...]) -> Iterator[StateOwner]:
    """Thermal nodes, whose state is their heat, or processes, which follow them, with the places of their states."""
    nodes = components is system.thermal
    first = system.counts["states"] - system.counts["shared"] + (0 if nodes else len(system.thermal))
    for component in components:
        own = HEAT if nodes else component.states
        states = tuple((state.name, state.unit, first + k) for k, state in enumerate(own))
        yield StateOwner(component.name, component, states)
        first += len(own)


def row_columns(sizes: Mapping[str, int]) -> dict[str, slice]:
    """Where each part of layout.ROW stands, for the given sizes."""
    columns, start = {}, 0
    for name, size in ROW:
        columns[name] = slice(start, start + sizes[size])
        start += sizes[size]
    return columns


def _ways(components: Iterable[Component]) -> Iterator[tuple[Component, Direction]]:
    return ((component, way) for component in components for way in directions(component))


def _branch(component: Component, way: Direction, places: NodePlaces) -> Branch:
    """A direction over the nodes and the housing."""
    direction: dict[int, float] = {}
    grounded: dict[Domain, float] = {}
    joined, domains = ports(component), port_domains(component)
    for port, coefficient in way.coefficients.items():
        index, factor = places.of(joined[port], HOUSING), float(coefficient)
        direction[index] = direction.get(index, 0.0) + factor
        if index == HOUSING:
            grounded[domains[port]] = grounded.get(domains[port], 0.0) + factor
    if not type(component).ways and "base" not in joined:
        # what brakes a shaft alone rests on the housing
        direction[HOUSING] = direction.get(HOUSING, 0.0) - 1.0
        grounded[way.domain] = grounded.get(way.domain, 0.0) - 1.0
    watched = way.way is not None and way.way.watched
    return Branch(way.name, component, direction, way.domain, grounded=grounded, number=way.number, watched=watched)


def _with_states(branches: list[Branch]) -> list[Branch]:
    """The same with the names and places of the states that they, or their friction laws, own."""
    made, first = list[Branch](), 0
    for branch in branches:
        law = branch.component.friction
        own = () if branch.number else tuple((branch.component if law is None else law).own_states())
        states = tuple((state.name, state.unit, first + k) for k, state in enumerate(own))
        made.append(replace(branch, states=states))
        first += len(own)
    return _with_places(made)


def _with_places(branches: list[Branch]) -> list[Branch]:
    """The same with the positions of stops among the states of these, in the unit of their motion."""
    named = {branch.name: branch for branch in branches}
    made = list[Branch]()
    for branch in branches:
        if isinstance(branch.component, StopTravel):
            branch = replace(branch, states=())
        elif branch.component.role is Role.CONTACT and is_stop(branch.component):
            ((name, _, index),) = named[place_of(branch.component)].states
            unit = "rad" if branch.domain is Domain.ROTATION else "m"
            branch = replace(branch, states=((name, unit, index),))
        made.append(branch)
    return made


def _domains(gear: Component) -> dict[str, Domain]:
    """Kind of motion at every port; the housing takes that of its fellow ports."""
    joined = ports(gear)
    moving = next((node.domain for node in joined.values() if not node.fixed), Domain.ROTATION)
    return {port: moving if node.fixed else node.domain for port, node in joined.items()}
