"""What a symbol is drawn with: strokes, circles and text in points, about an origin of its own."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from functools import lru_cache
from math import cos, pi, sin
from typing import Any, NamedTuple

from clutchwork.base.extras import need
from clutchwork.schematic.look import INK, THIN, MarkStyle

Point = tuple[float, float]


class Rect(NamedTuple):
    """A rectangle [pt]."""

    left: float
    low: float
    right: float
    high: float

    def overlaps(self, other: Rect, by: float = 0.0) -> bool:
        """Whether the two have more in common than a rim of width `by`."""
        return (
            min(self.right, other.right) - max(self.left, other.left) > by
            and min(self.high, other.high) - max(self.low, other.low) > by
        )

    def moved(self, x: float, y: float) -> Rect:
        """The same elsewhere."""
        return Rect(self.left + x, self.low + y, self.right + x, self.high + y)


class Stroke(NamedTuple):
    """A line through points, or an area with `look.fill`."""

    points: tuple[Point, ...]
    closed: bool
    look: MarkStyle

    @property
    def box(self) -> Rect:
        """What it covers."""
        xs, ys = [x for x, _ in self.points], [y for _, y in self.points]
        return Rect(min(xs), min(ys), max(xs), max(ys))

    def moved(self, x: float, y: float) -> Stroke:
        """The same elsewhere."""
        return self._replace(points=tuple((a + x, b + y) for a, b in self.points))


class Text(NamedTuple):
    """One line of text, centred on x, with its base line at y."""

    x: float
    y: float
    text: str
    size: float
    colour: str
    bold: bool

    @property
    def box(self) -> Rect:
        """What it covers."""
        half = 0.5 * width_of(self.text, self.size, self.bold)
        return Rect(self.x - half, self.y - 0.24 * self.size, self.x + half, self.y + 0.78 * self.size)

    def moved(self, x: float, y: float) -> Text:
        """The same elsewhere."""
        return self._replace(x=self.x + x, y=self.y + y)


Mark = Stroke | Text


class SymbolPen:
    """Collects marks; a mirrored one exchanges left and right of all but text."""

    def __init__(self, *, mirrored: bool = False) -> None:
        self.marks: list[Mark] = []
        self.sign = -1.0 if mirrored else 1.0

    def line(self, *points: Point, look: MarkStyle = INK, closed: bool = False) -> None:
        """A line through points."""
        self.marks.append(Stroke(tuple((self.sign * x, y) for x, y in points), closed, look))

    def area(self, *points: Point, look: MarkStyle = INK) -> None:
        """A closed line."""
        self.line(*points, look=look, closed=True)

    def box(self, left: float, low: float, right: float, high: float, look: MarkStyle = INK) -> None:
        """A rectangle."""
        self.area((left, low), (right, low), (right, high), (left, high), look=look)

    def circle(self, x: float, y: float, radius: float, look: MarkStyle = INK) -> None:
        """A circle."""
        self.area(*_round(x, y, radius, 0.0, 2.0 * pi)[:-1], look=look)

    def arc(self, x: float, y: float, radius: float, start: float, end: float, look: MarkStyle = INK) -> None:
        """A part of a circle between two angles [rad]."""
        self.line(*_round(x, y, radius, start, end), look=look)

    def arrow(self, tip: Point, direction: Point, size: float = 3.6, look: MarkStyle = INK) -> None:
        """A filled head; `direction` has the length 1."""
        (x, y), (a, b) = tip, direction
        back = (x - size * a, y - size * b)
        wide = (0.42 * size * -b, 0.42 * size * a)
        sides = ((back[0] + wide[0], back[1] + wide[1]), (back[0] - wide[0], back[1] - wide[1]))
        self.area(tip, *sides, look=look._replace(fill=look.colour, width=0.3))

    def ground(self, x: float, low: float, high: float) -> None:
        """The housing: a wall with hatching on its right."""
        self.line((x, low), (x, high), look=INK._replace(width=1.3))
        count = max(2, round((high - low) / 3.6))
        step = (high - low) / count
        for number in range(count):
            y = low + number * step
            self.line((x + 3.6, y), (x, y + step), look=THIN)

    def floor(self, left: float, right: float, y: float) -> None:
        """The housing or the road below something."""
        self.line((left, y), (right, y), look=INK._replace(width=1.3))
        count = max(2, round((right - left) / 3.6))
        step = (right - left) / count
        for number in range(count):
            x = left + number * step
            self.line((x, y - 3.6), (x + step, y), look=THIN)

    def hatched(self, left: float, low: float, right: float, high: float, look: MarkStyle = THIN) -> None:
        """Slanted lines within a rectangle."""
        step, height = 3.0, high - low
        start = left - height
        while start < right:
            first, last = max(start, left), min(start + height, right)
            if last > first:
                self.line((first, low + first - start), (last, low + last - start), look=look)
            start += step

    def text(self, x: float, y: float, text: str, size: float, colour: str = "", bold: bool = False) -> None:
        """One line of text, centred."""
        self.marks.append(Text(self.sign * x, y, text, size, colour or INK.colour, bold))

    def take(self, marks: list[Mark], x: float = 0.0, y: float = 0.0) -> None:
        """Marks of another pen."""
        self.marks += [mark.moved(x, y) for mark in marks]


def around(marks: Iterable[Any]) -> Rect:
    """What marks of any sort cover together."""
    boxes = [mark.box for mark in marks]
    return Rect(
        min(box.left for box in boxes),
        min(box.low for box in boxes),
        max(box.right for box in boxes),
        max(box.high for box in boxes),
    )


def _round(x: float, y: float, radius: float, start: float, end: float) -> tuple[Point, ...]:
    count = max(4, round(abs(end - start) * 8))
    angles = [start + (end - start) * number / count for number in range(count + 1)]
    return tuple((x + radius * cos(angle), y + radius * sin(angle)) for angle in angles)


@lru_cache(4096)
def width_of(text: str, size: float, bold: bool = False) -> float:
    """Width of a line of text [pt], as matplotlib sets it."""
    fonts = need("matplotlib.font_manager", "draw", "a schematic")
    paths = need("matplotlib.textpath", "draw", "a schematic")
    font = fonts.FontProperties(family="sans-serif", size=size, weight="bold" if bold else "normal")
    with warnings.catch_warnings():
        # a letter that the font lacks becomes a box of its width
        warnings.simplefilter("ignore", UserWarning)
        return float(paths.text_to_path.get_text_width_height_descent(text, font, False)[0])
