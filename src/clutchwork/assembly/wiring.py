"""Who is joined to what in a System, as the evaluation of results needs it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.kept import kept
from clutchwork.declare.layout import ROW
from clutchwork.declare.node import Component, Domain, Node
from clutchwork.declare.ports import ends, ports
from clutchwork.declare.schema import State
from clutchwork.model.parts import Sensor

if TYPE_CHECKING:
    from clutchwork.assembly.records import Link
    from clutchwork.assembly.system import System

# state of a thermal node
HEAT = (State("heat", "J", "heat that it holds above the start, or that an ambient took up"),)
HOUSING = -1  # index that stands for the housing, which is no node of the system


@dataclass(frozen=True)
class Branch:
    """A torque element, a contact or a prescribed speed: name, component and direction over the nodes."""

    name: str
    component: Any
    direction: Mapping[int, float]  # node index or HOUSING -> coefficient of its speed in the rate
    domain: Domain
    states: tuple[tuple[str, str, int], ...] = ()  # (name, unit, index among all states)

    @property
    def hidden(self) -> bool:
        """Whether it only measures a speed."""
        return isinstance(self.component, Sensor)


@dataclass(frozen=True)
class Source:
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
    thermal: tuple[Source, ...] = ()
    processes: tuple[Source, ...] = ()
    flows: tuple[str, ...] = ()
    links: tuple[Link, ...] = ()
    sums: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    unused: frozenset[str] = frozenset()  # inputs of features that nobody asked for

    @property
    def row_size(self) -> int:
        """Numbers in one output row."""
        return max((part.stop for part in self.columns.values()), default=0)

    def spread(self, branches: tuple[Branch, ...]) -> NDArray[np.float64]:
        """Torque on every node per torque of every branch, shape (nodes, branches)."""
        matrix = np.zeros((len(self.nodes), len(branches)))
        for column, branch in enumerate(branches):
            for node, coefficient in branch.direction.items():
                if node != HOUSING:
                    matrix[node, column] += coefficient
        return matrix


@kept
def wiring(system: System) -> Wiring:
    """The connections of a System, found once."""
    places = {id(node): index for index, node in enumerate(system.nodes)}
    gears = [GearRow(row.gear.name, dict(row.ports), _domains(row.gear)) for row in system.gears]
    branches = [_branch(component, places) for component in (*system.elements, *system.contacts)]
    branches = _with_states(branches)
    return Wiring(
        nodes=system.nodes,
        elements=tuple(branches[: len(system.elements)]),
        contacts=tuple(branches[len(system.elements) :]),
        motions=tuple(_branch(component, places) for component in system.motions),
        gears=tuple(gears),
        inputs=tuple((item.name, item.unit) for item in system.inputs),
        columns=row_columns(system.counts),
        thermal=tuple(_shared(system, system.thermal)),
        processes=tuple(_shared(system, system.processes)),
        flows=tuple(flow.name for flow in system.flows),
        links=system.links,
        sums=system.sums,
        unused=frozenset(item.name for item in system.inputs if not item.given),
    )


def _shared(system: System, components: tuple[Any, ...]) -> Iterator[Source]:
    """Thermal nodes, whose state is their heat, or processes, which follow them, with the places of their states."""
    nodes = components is system.thermal
    first = system.counts["states"] - system.counts["shared"] + (0 if nodes else len(system.thermal))
    for component in components:
        own = HEAT if nodes else component.states
        states = tuple((state.name, state.unit, first + k) for k, state in enumerate(own))
        yield Source(component.name, component, states)
        first += len(own)


def row_columns(sizes: Mapping[str, int]) -> dict[str, slice]:
    """Where each part of layout.ROW stands, for the given sizes."""
    columns, start = {}, 0
    for name, size in ROW:
        columns[name] = slice(start, start + sizes[size])
        start += sizes[size]
    return columns


def _branch(component: Component, places: Mapping[int, int]) -> Branch:
    """Direction follower - base or shaft - base, over the nodes and the housing."""
    moving, base = ends(component)
    direction: dict[int, float] = {}
    for node, factor in ((moving, 1.0), (base, -1.0)):
        index = places.get(id(node), HOUSING)
        direction[index] = direction.get(index, 0.0) + factor
    return Branch(component.name, component, direction, base.domain if moving.fixed else moving.domain)


def _with_states(branches: list[Branch]) -> list[Branch]:
    """The same with the names and places of the states that they, or their friction laws, own."""
    made, first = list[Branch](), 0
    for branch in branches:
        law = branch.component.friction
        own = tuple(branch.component.states if law is None else law.own_states())
        states = tuple((state.name, state.unit, first + k) for k, state in enumerate(own))
        made.append(replace(branch, states=states))
        first += len(own)
    return made


def _domains(gear: Component) -> dict[str, Domain]:
    """Kind of motion at every port; the housing takes that of its fellow ports."""
    joined = ports(gear)
    moving = next((node.domain for node in joined.values() if not node.fixed), Domain.ROTATION)
    return {port: moving if node.fixed else node.domain for port, node in joined.items()}
