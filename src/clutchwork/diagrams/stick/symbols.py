"""How shift elements look: clutch, brake, freewheel, dog clutch; closed ones are filled."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from clutchwork.diagrams.marks import IDLE, INK, PAPER, Pen, Point

# from along and across to a point of the picture
Place = Callable[[float, float], Point]
PLATE, LINING = 9.0, 2.6  # half width of plates; half of what is between them
MACHINE = "machine"


class Looks(NamedTuple):
    """Colours of a symbol: of its two sides, and of what is between them."""

    sides: tuple[str, str] = (INK, INK)
    between: str = PAPER
    widths: tuple[float, float] = (1.4, 1.4)


OPEN = Looks((IDLE, IDLE))


def gap_of(kind: str) -> float:
    """Half of what is between the two sides."""
    return {"freewheel": 5.0, "dog": 5.0, MACHINE: 8.0}.get(kind, LINING)


def draw(pen: Pen, kind: str, middle: Point, along: Point, reaches: tuple[float, float], looks: Looks) -> None:
    """A symbol at a place.

    Parameters: along, direction from the first end to the second, of length 1; reaches, from the middle to either end.
    """

    def at(u: float, v: float) -> Point:
        return middle[0] + u * along[0] - v * along[1], middle[1] + u * along[1] + v * along[0]

    gap = gap_of(kind)
    for sign, reach, colour, width in zip((-1.0, 1.0), reaches, looks.sides, looks.widths, strict=True):
        if reach > gap:
            pen.line(at(sign * reach, 0.0), at(sign * gap, 0.0), colour=colour, width=width)
    if kind == MACHINE:
        _machine(pen, at, looks)
        return
    if kind == "freewheel":
        _roller(pen, at, looks)
    elif kind == "dog":
        _teeth(pen, at, gap, looks)
    else:
        pen.area(at(-gap, -PLATE), at(gap, -PLATE), at(gap, PLATE), at(-gap, PLATE), fill=looks.between)
    for sign, colour in zip((-1.0, 1.0), looks.sides, strict=True):
        pen.line(at(sign * gap, -PLATE), at(sign * gap, PLATE), colour=colour, width=2.4)


def _machine(pen: Pen, at: Place, looks: Looks) -> None:
    """An electric machine, a circle with its letter."""
    x, y = at(0.0, 0.0)
    colour = looks.sides[0] if looks.between == PAPER else looks.between
    pen.dot(x, y, 8.0, PAPER, colour, 1.8)
    pen.label(x, y + 3.4, "M", 9.0, colour, bold=True, anchor="middle")


def _roller(pen: Pen, at: Place, looks: Looks) -> None:
    """A roller in a wedge."""
    pen.line(at(-5.0, -7.0), at(5.0, -3.0), colour=looks.sides[0], width=1.2)
    x, y = at(0.0, 1.5)
    pen.dot(x, y, 4.2, looks.between, looks.sides[1], 1.2)


def _teeth(pen: Pen, at: Place, gap: float, looks: Looks) -> None:
    """Teeth of both sides in each other's gaps, apart where it is open."""
    for number, v in enumerate((-6.0, -2.0, 2.0, 6.0)):
        sign, colour = (1.0, looks.sides[1]) if number % 2 else (-1.0, looks.sides[0])
        reach = -0.6 * gap if looks.between != PAPER else 0.1 * gap
        pen.area(
            at(sign * gap, v - 1.5), at(sign * reach, v - 1.5), at(sign * reach, v + 1.5), at(sign * gap, v + 1.5),
            fill=colour,
        )  # fmt: skip
