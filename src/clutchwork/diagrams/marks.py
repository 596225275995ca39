"""Marks of a diagram, in pixels with y downwards, and the pen that collects them."""

from __future__ import annotations

from typing import NamedTuple

from clutchwork.diagrams.letters import width_of
from clutchwork.schematic.pen import Rect

Point = tuple[float, float]
INK, GREY, FAINT, PAPER = "#1A1A1A", "#6A6A6A", "#B8B8B8", "#FFFFFF"
POWER, HELD, IDLE = "#B8430A", "#00497A", "#8A8A8A"
TITLE, NAME, SMALL = 14.0, 10.5, 9.0  # px, sizes of text


# letters that go below the base line
_LOW = frozenset("gjpqyQ,;()[]{}|/_@$")


class Polyline(NamedTuple):
    """A line through points; closed and filled, an area."""

    points: tuple[Point, ...]
    colour: str = INK
    width: float = 1.4
    fill: str = ""
    closed: bool = False
    dash: str = ""
    what: str = ""  # shown where a pointer rests on it

    @property
    def box(self) -> Rect:
        """What it covers."""
        xs, ys = [x for x, _ in self.points], [y for _, y in self.points]
        half = 0.5 * self.width
        return Rect(min(xs) - half, min(ys) - half, max(xs) + half, max(ys) + half)


class Disc(NamedTuple):
    """A filled circle."""

    x: float
    y: float
    radius: float
    fill: str = INK
    colour: str = INK
    width: float = 0.0

    @property
    def box(self) -> Rect:
        """What it covers."""
        reach = self.radius + 0.5 * self.width
        return Rect(self.x - reach, self.y - reach, self.x + reach, self.y + reach)


class Label(NamedTuple):
    """A line of text whose base line is at y, with its start, middle or end at x."""

    x: float
    y: float
    text: str
    size: float = SMALL
    colour: str = INK
    bold: bool = False
    anchor: str = "middle"

    @property
    def box(self) -> Rect:
        """What it covers."""
        wide = width_of(self.text, self.size, bold=self.bold)
        left = self.x - {"start": 0.0, "middle": 0.5, "end": 1.0}[self.anchor] * wide
        below = 0.22 if _LOW.intersection(self.text) else 0.02
        return Rect(left, self.y - 0.76 * self.size, left + wide, self.y + below * self.size)


Mark = Polyline | Disc | Label


class Pen:
    """Collects marks."""

    def __init__(self) -> None:
        self.marks: list[Mark] = []

    def line(self, *points: Point, colour: str = INK, width: float = 1.4, dash: str = "", what: str = "") -> None:
        """A line through points."""
        self.marks.append(Polyline(points, colour, width, dash=dash, what=what))

    def area(self, *points: Point, fill: str, colour: str = "", width: float = 0.0, what: str = "") -> None:
        """A filled area, with an outline where it has a width."""
        self.marks.append(Polyline(points, colour or fill, width, fill, closed=True, what=what))

    def rectangle(self, box: Rect, fill: str, colour: str = "", width: float = 0.0) -> None:
        """A filled rectangle."""
        corners = ((box.left, box.low), (box.right, box.low), (box.right, box.high), (box.left, box.high))
        self.area(*corners, fill=fill, colour=colour, width=width)

    def dot(self, x: float, y: float, radius: float, fill: str = INK, colour: str = INK, width: float = 0.0) -> None:
        """A filled circle."""
        self.marks.append(Disc(x, y, radius, fill, colour, width))

    def arrow(self, tip: Point, way: Point, size: float, fill: str = INK, what: str = "") -> None:
        """A filled head; `way` has the length 1."""
        (x, y), (a, b) = tip, way
        back, wide = (x - size * a, y - size * b), 0.45 * size
        sides = ((back[0] - wide * b, back[1] + wide * a), (back[0] + wide * b, back[1] - wide * a))
        self.area(tip, *sides, fill=fill, what=what)

    def label(
        self, x: float, y: float, text: str, size: float = SMALL, colour: str = INK,
        *, bold: bool = False, anchor: str = "middle",
    ) -> None:  # fmt: skip
        """A line of text; nothing where it is empty."""
        if text:
            self.marks.append(Label(x, y, text, size, colour, bold, anchor))
