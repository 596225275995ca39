"""A symbol: how it is drawn, its size, and where its ports are."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from typing import Any

from clutchwork.base import dataclass
from clutchwork.schematic.look import SHAFT, MarkStyle
from clutchwork.schematic.pen import SymbolPen

LEFT, RIGHT = -1, 1


@dataclass(frozen=True)
class Drawn:
    """What is drawn of one element, seen so that the first port is on the left."""

    element: Any
    sides: Mapping[str, int]  # port -> LEFT or RIGHT; the others are at the housing or at nothing
    fixed: frozenset[str] = frozenset()  # ports at the housing
    state: str = ""
    line: MarkStyle = SHAFT  # of what it is attached to
    parts: frozenset[str] = frozenset()  # states of its parts, such as "forward:locked"
    half: float = 16.0
    pins: Mapping[str, float] = field(default_factory=dict)  # y of each port


@dataclass(frozen=True)
class Symbol:
    """A symbol about its middle; `pins` are the heights of its ports where they are not zero."""

    draw: Callable[[SymbolPen, Drawn], None]
    half: float = 16.0  # pt, to the ends of its lines
    up: float = 12.0
    down: float = 12.0
    pins: Mapping[str, float] | Callable[[Any], Mapping[str, float]] = field(default_factory=dict)
    ground: bool = True  # a port at the housing shows it

    def heights(self, element: Any) -> Mapping[str, float]:
        """Heights of the ports of an element."""
        return self.pins(element) if callable(self.pins) else self.pins


def ends(pen: SymbolPen, shown: Drawn, left: float, right: float) -> None:
    """Lines to both ends of a symbol with two ports; the housing where nothing is attached."""
    for side, to in ((LEFT, left), (RIGHT, right)):
        if side in shown.sides.values():
            pen.line((side * shown.half, 0.0), (to, 0.0), look=shown.line)
        else:
            wall(pen, side, to, shown)


def wall(pen: SymbolPen, side: int, to: float, shown: Drawn, y: float = 0.0, tall: float = 8.0) -> None:
    """A line that ends at the housing."""
    pen.line((to, y), (side * (shown.half - 4.0), y), look=shown.line)
    flipped = SymbolPen()
    flipped.ground(shown.half - 4.0, y - tall, y + tall)
    for mark in flipped.marks:
        pen.line(*((side * a, b) for a, b in mark.points), look=mark.look)  # type: ignore[union-attr]
