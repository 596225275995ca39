"""What the reduction works on: nodes, elements by role, rigid rows, and node speeds over the independent ones."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from functools import cached_property
from math import inf, isfinite
from numbers import Real
from typing import Any

from clutchwork.base import dataclass
from clutchwork.declare.node import Component, Domain, Node
from clutchwork.declare.ports import coefficients, ports
from clutchwork.declare.rational import MINUS, ONE, Row, exact, plus
from clutchwork.declare.schema import Role
from clutchwork.declare.wording import path_of
from clutchwork.model.numbers import as_float


class NodePlaces:
    """Place of each node by identity; by name where it is inside of a composite, which makes it anew when asked."""

    def __init__(self, nodes: Sequence[Node]) -> None:
        self._by_identity = {id(node): place for place, node in enumerate(nodes)}
        self._by_name = {node.name: place for place, node in enumerate(nodes)}

    def of(self, node: Node, housing: int = -1) -> int:
        """Place of a node."""
        if node.fixed:
            return housing
        found = self._by_identity.get(id(node))
        return self._by_name[node.name] if found is None else found


@dataclass(frozen=True)
class Mechanism:
    """Nodes and elements of a driveline.

    Columns of all rows are the nodes in order, then the prescribed inputs in order.
    """

    nodes: tuple[Node, ...]
    components: tuple[Component, ...]
    inner: int = 0  # of the nodes the last ones, which are inside of composites
    grips: tuple[tuple[str, Node, Node], ...] = ()  # parts that are closed at the start, and what turns together there

    def role(self, role: Role) -> list[Any]:
        """The elements of one role, in order."""
        return [component for component in self.components if component.role is role]

    @cached_property
    def geared(self) -> list[Any]:
        """Gears, and contacts that are gears with friction."""
        return [*self.role(Role.GEAR), *(contact for contact in self.role(Role.CONTACT) if follows_load(contact))]

    @cached_property
    def acting(self) -> list[tuple[Any, Row]]:
        """Torque elements and contacts with their rate over the nodes, one entry for each of their ways."""
        return [(c, row) for role in (Role.TORQUE, Role.CONTACT) for c in self.role(role) for row in self.directions(c)]

    @cached_property
    def places(self) -> NodePlaces:
        """Place of each node."""
        return NodePlaces(self.nodes)

    @cached_property
    def inertia(self) -> list[Fraction]:
        """Inertia of each node; 1 where what is given makes no sense, which is reported elsewhere."""
        return [exact(node.inertia) if _sensible(node.inertia, 0.0) else ONE for node in self.nodes]

    @cached_property
    def speed(self) -> list[Fraction | None]:
        """Given speed of each node at the start."""
        return [exact(node.speed or 0.0) if _sensible(node.speed) else None for node in self.nodes]

    def direction(self, component: Component) -> Row:
        """Rate of an element over the nodes, of its first way where it has several."""
        return self.directions(component)[0]

    def directions(self, component: Component) -> list[Row]:
        """Rate of each way of an element over the nodes."""
        joined = ports(component)
        return [self._over(joined, way) for way in coefficients(component)]

    def slip(self, base: Node, follower: Node) -> Row:
        """Speed of one node over that of another, over the nodes."""
        return self._over({"base": base, "follower": follower}, {"base": MINUS, "follower": ONE})

    def _over(self, joined: Mapping[str, Node], coefficients: Mapping[str, Fraction]) -> Row:
        row: Row = {}
        for port, coefficient in coefficients.items():
            node = joined[port]
            if coefficient and not node.fixed:
                place = self.places.of(node)
                row = plus(row, ONE, {place: coefficient}) if place in row else {**row, place: coefficient}
        return row

    @cached_property
    def gear_rows(self) -> list[tuple[Any, Mapping[str, Node], Mapping[str, Fraction]]]:
        """Each row of the gears by port: its gear, what that joins, and the coefficients."""
        return [(gear, ports(gear), row) for gear in self.geared for row in gear.rows()]

    def rigid_rows(self) -> Iterator[RigidRow]:
        """Rows of all gears, then of contacts that have some, then of all prescribed speeds."""
        for gear, joined, row in self.gear_rows:
            yield RigidRow(path_of(gear), self._over(joined, row), gear)
        for number, motion in enumerate(self.role(Role.MOTION), len(self.nodes)):
            yield RigidRow(path_of(motion), {**self.direction(motion), number: MINUS}, motion)

    def node_label(self, place: int) -> str:
        """Path of a node in messages."""
        node = self.nodes[place]
        return f'{"mass" if node.domain is Domain.TRANSLATION else "shaft"} "{node.name}"'


def follows_load(component: Component) -> bool:
    """Whether the capacity of a contact follows the torque of its own gear row."""
    return "bound" in component.hooks


def _sensible(value: Any, least: float = -inf) -> bool:
    return isinstance(value, Real) and isfinite(as_float(value)) and float(value) >= least


@dataclass(frozen=True)
class RigidRow:
    """One rigid row: sum of coefficient times speed = 0, over nodes and prescribed inputs."""

    owner: str  # 'element "g1" (gear)'
    coefficients: Row
    component: Any = None


@dataclass
class Kinematics:
    """The speed of every node over the independent nodes and the prescribed inputs."""

    speeds: list[Row]
    independent: list[int]  # nodes, in the order of the reduced coordinates
    massless: set[int]  # of these
    followers: dict[int, int] = field(default_factory=dict)  # transmission -> massless node that follows from it
    loose: frozenset[int] = frozenset()  # nodes whose initial speed follows from springs in series
    notes: list[str] = field(default_factory=list)

    def over(self, direction: Row) -> Row:
        """A rate, given over the nodes, over the independent nodes and the prescribed inputs."""
        made: Row = {}
        for node, factor in direction.items():
            made = plus(made, factor, self.speeds[node])
        return made

    def moved_by(self, node: int) -> list[int]:
        """Nodes that move when an independent one does."""
        return [place for place, row in enumerate(self.speeds) if node in row]
