"""Gear sets on the grid of a stick diagram: their wheels, the lines of their members, the cells that they cover."""

from __future__ import annotations

from dataclasses import field
from typing import NamedTuple

from clutchwork.base.classes import dataclass
from clutchwork.gearbox.gear_set import HOUSING, GearSet

Node = tuple[int, int]  # column from the left, row above the centre line

BASE = 5  # row of suns: as many lines less one pass between the centre line and a sun
REACH, APART = 2, 3  # columns from a wheel to the edge of its set, and from wheel to wheel


class Bar(NamedTuple):
    """The teeth of a wheel that faces its planet: at `row`, upwards where it is a sun."""

    port: str
    at: Node
    up: bool


class Planet(NamedTuple):
    """A planet wheel: its middle, the rows of its lowest and highest teeth, the name of their number, its width."""

    at: Node
    low: int
    high: int
    teeth: str = ""
    wide: int = 0


@dataclass(frozen=True)
class Piece:
    """What a member has in a set: where its power enters, its lines, and the ends that others join."""

    member: str
    root: Node
    lines: tuple[tuple[Node, Node], ...]
    ends: tuple[Node, ...]


@dataclass(frozen=True)
class Body:
    """A gear set as it is drawn; all nodes are moved to its place."""

    name: str
    width: int
    top: int
    bars: list[Bar] = field(default_factory=list)
    planets: list[Planet] = field(default_factory=list)
    pieces: dict[str, Piece] = field(default_factory=dict)
    solid: set[Node] = field(default_factory=set)
    # planets that turn together, by the columns of the first and the last wheel and their row
    joined: list[tuple[Node, Node]] = field(default_factory=list)

    def placed(self, column: int, *, mirrored: bool) -> Body:
        """The same with its left edge in a column, or turned about."""

        def to(node: Node) -> Node:
            return (column + (self.width - node[0] if mirrored else node[0]), node[1])

        def planet(one: Planet) -> Planet:
            start = (one.at[0] + one.wide if mirrored else one.at[0], one.at[1])
            return one._replace(at=to(start))

        def piece(one: Piece) -> Piece:
            lines = tuple((to(a), to(b)) for a, b in one.lines)
            return Piece(one.member, to(one.root), lines, tuple(to(end) for end in one.ends))

        joined = [tuple(sorted((to(a), to(b)))) for a, b in self.joined]
        return Body(
            self.name, self.width, self.top,
            [bar._replace(at=to(bar.at)) for bar in self.bars],
            [planet(one) for one in self.planets],
            {port: piece(one) for port, one in self.pieces.items()},
            {to(node) for node in self.solid},
            [(first, last) for first, last in joined],
        )  # fmt: skip


def body(one: GearSet) -> Body:
    """A gear set at column 0."""
    made = _ravigneaux(one) if one.kind == "ravigneaux" else _double(one) if one.kind == "double" else _planes(one)
    ends = {end for piece in made.pieces.values() for end in piece.ends if piece.member != HOUSING}
    made.solid.difference_update(ends)
    return made


def _wheel(made: Body, one: GearSet, port: str, at: Node, *, up: bool) -> None:
    """A sun with its end below, or a ring with its end above."""
    column, row = at
    end = (column, row - 1) if up else (column, row + 1)
    made.bars.append(Bar(port, at, up))
    made.pieces[port] = Piece(one.members[port], at, ((at, end),), (end,))
    if one.members[port] == HOUSING:
        made.solid.update((column + n, end[1] + step) for n in (-1, 0, 1) for step in ((0, -1) if up else (0, 1)))


def _pin(
    made: Body, port: str, member: str, middle: Node, width: int, more: tuple[tuple[Node, Node], ...] = ()
) -> None:
    """A pin through planets, from edge to edge of the set."""
    left, right = (0, middle[1]), (width, middle[1])
    made.pieces[port] = Piece(member, middle, ((left, middle), (middle, right), *more), (left, right))


def _cover(made: Body, left: int, right: int, low: int, high: int) -> None:
    made.solid.update((c, r) for c in range(left, right + 1) for r in range(low, high + 1))


def _planes(one: GearSet) -> Body:
    """Planets on one pin, with a wheel for each plane: single, stepped, two suns, two rings, a pair of gears."""
    if one.kind == "gear":
        planes = [(("first", ""), "")]
    elif one.kind == "single":
        planes = [(("sun", "ring"), "planet")]
    else:
        planes = [((wheel.port, ""), wheel.planet) for wheel in one.shape.wheels]
    sizes = [one.teeth.get(planet, 0) for _, planet in planes]
    radii = [3 if len(planes) > 1 and size == max(sizes) and min(sizes) < size else 2 for size in sizes]
    width, pin = 2 * REACH + APART * (len(planes) - 1), BASE + max(radii)
    made = Body(one.name, width, pin + max(radii))
    _cover(made, 0, width, BASE, made.top)
    for number, ((ports, planet), radius) in enumerate(zip(planes, radii, strict=True)):
        column = REACH + APART * number
        made.planets.append(Planet((column, pin), pin - radius, pin + radius, planet))
        for port in filter(None, ports):
            ring = "ring" in port
            _wheel(made, one, port, (column, pin + radius if ring else pin - radius), up=not ring)
    if len(planes) > 1:
        made.joined.append(((REACH, pin), (width - REACH, pin)))
    turned = "second" if one.kind == "gear" else "carrier"
    _pin(made, turned, one.members[turned], (REACH, pin), width)
    if turned == "second":
        # it turns with its shaft, so its teeth stand at the wheel
        made.planets[0] = made.planets[0]._replace(teeth="second")
    return made


def _double(one: GearSet) -> Body:
    """Two planets, one above the other, whose pins a web joins on the left."""
    width, inner, outer = 2 * REACH, BASE + 2, BASE + 6
    made = Body(one.name, width, BASE + 8)
    _cover(made, 0, width, BASE, made.top)
    made.planets.extend(Planet((REACH, pin), pin - 2, pin + 2) for pin in (inner, outer))
    _wheel(made, one, "sun", (REACH, BASE), up=True)
    _wheel(made, one, "ring", (REACH, made.top), up=False)
    more = (((0, inner), (0, outer)), ((0, outer), (REACH, outer)))
    _pin(made, "carrier", one.members["carrier"], (REACH, inner), width, more)
    return made


def _ravigneaux(one: GearSet) -> Body:
    """The large sun on the left below the long planet; on the right a short one between it and the small sun."""
    near, far = REACH, REACH + 4
    width, short, long = far + REACH, BASE + 2, BASE + 6
    made = Body(one.name, width, BASE + 8)
    _cover(made, 0, width, BASE + 4, made.top)
    _cover(made, far - REACH, width, BASE, made.top)
    made.planets.extend(
        (Planet((far, short), BASE, BASE + 4), Planet((near, long), BASE + 4, BASE + 8, wide=far - near))
    )
    _wheel(made, one, "large_sun", (near, BASE + 4), up=True)
    _wheel(made, one, "small_sun", (far, BASE), up=True)
    _wheel(made, one, "ring", (near, made.top), up=False)
    more = (((width, long), (width, short)), ((width, short), (far, short)))
    _pin(made, "carrier", one.members["carrier"], (near, long), width, more)
    return made
