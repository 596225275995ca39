"""Colours and widths of a stick diagram: in ink, or by the power of a gear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from clutchwork.base import dataclass
from clutchwork.diagrams.marks import HELD, IDLE, INK, POWER, Point
from clutchwork.diagrams.power import INPUT, OUTPUT, sources
from clutchwork.diagrams.stick.bodies import Node
from clutchwork.diagrams.stick.layout import Layout
from clutchwork.gearbox.gear_set import HOUSING

if TYPE_CHECKING:
    from clutchwork.diagrams.shown import BoxAtWork
    from clutchwork.gearbox.definition import Definition

THIN, THICK, MOST = 1.5, 2.6, 1.25  # px: width without power, more at power 1, power from which on it grows no more
LOST = 1e-9


@dataclass(frozen=True, eq=False)
class Scene:
    """A gearbox on its grid, in a gear where `now` is given."""

    box: Definition
    plan: Layout
    now: BoxAtWork | None

    def at(self, node: Node) -> Point:
        """Where a node of the grid is [px]."""
        return self.plan.columns[node[0]], -self.plan.rows[node[1]]

    def colour(self, member: str, power: float = 0.0) -> str:
        """Colour of a line of a member."""
        if self.now is None:
            return INK
        if member == HOUSING or abs(self.now.speeds[member]) < LOST:
            return HELD
        return POWER if abs(power) > LOST else IDLE

    def width(self, power: float) -> float:
        """Width of a line by its power."""
        return THIN + (THICK * min(abs(power), MOST) if abs(power) > LOST else 0.0)

    def gate(self, name: str) -> tuple[str, float]:
        """Colour and width of the line at the input or the output."""
        if self.now is None:
            return INK, self.width(0.0)
        member, power = (self.box.input, self.now.given) if name == INPUT[1] else (self.box.output, self.now.taken)
        return self.colour(member, power), self.width(power)

    def taken(self) -> dict[str, dict[Node, float]]:
        """Power that enters each member, by node."""
        if self.now is None:
            return {member: {} for member in self.box.members}
        found = dict[str, dict[Node, float]]()
        for member, given in sources(self.box, self.now).items():
            here = found.setdefault(member, {})
            for source, power in given.items():
                node = self._node(member, *source)
                here[node] = here.get(node, 0.0) + power
        return found

    def _node(self, member: str, name: str, port: str) -> Node:
        if (name, port) in (INPUT, OUTPUT):
            return self.plan.gates[port]
        if port:
            return self.plan.roots[name, port]
        symbol = self.plan.symbols[name]
        return symbol.first if self.plan.ends[symbol.first] == member else symbol.second
