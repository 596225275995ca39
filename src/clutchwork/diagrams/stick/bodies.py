"""Gear sets on the grid of a stick diagram: their wheels, the lines of their members, the cells that they cover."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from typing import NamedTuple

from clutchwork.base import dataclass
from clutchwork.gearbox.gear_set import HOUSING, GearSet

Node = tuple[int, int]  # column from the left, row above the centre line
Source = tuple[str, str]  # a set and its port

BASE = 5  # row of suns: as many lines less one pass between the centre line and a sun
REACH, APART = 2, 3  # columns from a wheel to the edge of its set, and from wheel to wheel


class Bar(NamedTuple):
    """The teeth of a wheel that faces its planet: at `row`, upwards where it is a sun."""

    source: Source
    at: Node
    up: bool


class Planet(NamedTuple):
    """A planet wheel: its middle, the rows of its lowest and highest teeth, the name of their number, its width."""

    at: Node
    low: int
    high: int
    teeth: Source = ("", "")
    wide: int = 0


@dataclass(frozen=True)
class MemberPiece:
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
    pieces: dict[Source, MemberPiece] = field(default_factory=dict)
    solid: set[Node] = field(default_factory=set)
    # planets that turn together, by the columns of the first and the last wheel and their row
    joined: list[tuple[Node, Node]] = field(default_factory=list)

    @property
    def lopsided(self) -> bool:
        """Whether it is another drawing when it is turned about."""
        return len(self.planets) > 1

    def placed(self, column: int, *, mirrored: bool) -> Body:
        """The same with its left edge in a column, or turned about."""

        def to(node: Node) -> Node:
            return (column + (self.width - node[0] if mirrored else node[0]), node[1])

        def planet(one: Planet) -> Planet:
            start = (one.at[0] + one.wide if mirrored else one.at[0], one.at[1])
            return one._replace(at=to(start))

        def piece(one: MemberPiece) -> MemberPiece:
            lines = tuple((to(a), to(b)) for a, b in one.lines)
            return MemberPiece(one.member, to(one.root), lines, tuple(to(end) for end in one.ends))

        joined = [tuple(sorted((to(a), to(b)))) for a, b in self.joined]
        return Body(
            self.name, self.width, self.top,
            [bar._replace(at=to(bar.at)) for bar in self.bars],
            [planet(one) for one in self.planets],
            {source: piece(one) for source, one in self.pieces.items()},
            {to(node) for node in self.solid},
            [(first, last) for first, last in joined],
        )  # fmt: skip


def bodies(sets: Sequence[GearSet]) -> list[Body]:
    """All gear sets at column 0; those that share their planets are one."""
    groups: dict[object, list[GearSet]] = {}
    for one in sets:
        groups.setdefault(_shared(one), []).append(one)
    return [_body(group) for group in groups.values()]


def _shared(one: GearSet) -> object:
    """What two sets have in common whose planets turn alike: their carrier, and one wheel with its planet wheel."""
    if one.kind not in ("stepped", "two_suns") or one.ratios:
        return one.name
    last = one.shape.wheels[-1]
    return one.kind, one.carrier, one.members[last.port], one.teeth[last.port], one.teeth[last.planet]


def _body(group: Sequence[GearSet]) -> Body:
    one = group[0]
    made = _ravigneaux(one) if one.kind == "ravigneaux" else _double(one) if one.kind == "double" else _planes(group)
    ends = {end for piece in made.pieces.values() for end in piece.ends if piece.member != HOUSING}
    made.solid.difference_update(ends)
    return made


def _wheel(made: Body, one: GearSet, port: str, at: Node, *, up: bool) -> None:
    """A sun with its end below, or a ring with its end above."""
    column, row = at
    end = (column, row - 1) if up else (column, row + 1)
    made.bars.append(Bar((one.name, port), at, up))
    made.pieces[one.name, port] = MemberPiece(one.members[port], at, ((at, end),), (end,))
    if one.members[port] == HOUSING:
        made.solid.update((column + n, end[1] + step) for n in (-1, 0, 1) for step in ((0, -1) if up else (0, 1)))


def _pin(made: Body, source: Source, member: str, middle: Node, more: tuple[tuple[Node, Node], ...] = ()) -> None:
    """A pin through planets, from edge to edge of the set."""
    left, right = (0, middle[1]), (made.width, middle[1])
    made.pieces[source] = MemberPiece(member, middle, ((left, middle), (middle, right), *more), (left, right))


def _cover(made: Body, left: int, right: int, low: int, high: int) -> None:
    made.solid.update((c, r) for c in range(left, right + 1) for r in range(low, high + 1))


class _Plane(NamedTuple):
    """A plane of wheels: its set, the ports in it, the name of the teeth of its planet wheel."""

    one: GearSet
    ports: tuple[str, ...]
    planet: str

    @property
    def size(self) -> int:
        """Teeth of its planet wheel."""
        return self.one.teeth.get(self.planet, 0)


def _planes(group: Sequence[GearSet]) -> Body:
    """Planets on one pin, with a wheel for each plane: single, stepped, two suns, two rings, a pair of gears."""
    one = group[0]
    if len(one.shape.wheels) > 1 and one.shape.wheels[-1].planet:
        *firsts, last = one.shape.wheels
        planes = [_Plane(other, (wheel.port,), wheel.planet) for other in group for wheel in firsts]
        planes.append(_Plane(one, (last.port,), last.planet))
    else:
        planes = [_Plane(one, ("first",), "second") if one.kind == "gear" else _Plane(one, ("sun", "ring"), "planet")]
    # larger planets are drawn larger, in at most three sizes
    ranks = sorted({plane.size for plane in planes})
    radii = [2 + min(2, ranks.index(plane.size)) for plane in planes]
    pin = BASE + max(radii)
    made = Body("+".join(other.name for other in group), 2 * REACH + APART * (len(planes) - 1), pin + max(radii))
    for number, (plane, radius) in enumerate(zip(planes, radii, strict=True)):
        column = REACH + APART * number
        # an end of a wheel is free below it or above it
        _cover(made, column - REACH, column + REACH, pin - radius, pin + radius)
        made.planets.append(Planet((column, pin), pin - radius, pin + radius, (plane.one.name, plane.planet)))
        for port in plane.ports:
            ring = "ring" in port
            _wheel(made, plane.one, port, (column, pin + radius if ring else pin - radius), up=not ring)
    if len(planes) > 1:
        made.joined.append(((REACH, pin), (made.width - REACH, pin)))
    turned = "second" if one.kind == "gear" else "carrier"
    _pin(made, (one.name, turned), one.members[turned], (REACH, pin))
    for other in group[1:]:
        # what they share is drawn once
        shared = {(other.name, port): made.pieces[one.name, port] for port in ("carrier", one.shape.wheels[-1].port)}
        made.pieces.update(shared)
    return made


def _double(one: GearSet) -> Body:
    """Two planets, one above the other, whose pins a web joins on the left."""
    inner, outer = BASE + 2, BASE + 6
    made = Body(one.name, 2 * REACH, BASE + 8)
    _cover(made, 0, made.width, BASE, made.top)
    made.planets.extend(Planet((REACH, pin), pin - 2, pin + 2) for pin in (inner, outer))
    _wheel(made, one, "sun", (REACH, BASE), up=True)
    _wheel(made, one, "ring", (REACH, made.top), up=False)
    more = (((0, inner), (0, outer)), ((0, outer), (REACH, outer)))
    _pin(made, (one.name, "carrier"), one.members["carrier"], (REACH, inner), more)
    return made


def _ravigneaux(one: GearSet) -> Body:
    """The large sun on the left below the long planet; on the right a short one between it and the small sun."""
    near, far = REACH, REACH + 4
    short, long = BASE + 2, BASE + 6
    made = Body(one.name, far + REACH, BASE + 8)
    _cover(made, 0, made.width, BASE + 4, made.top)
    _cover(made, far - REACH, made.width, BASE, made.top)
    made.planets.append(Planet((far, short), BASE, BASE + 4))
    made.planets.append(Planet((near, long), BASE + 4, BASE + 8, wide=far - near))
    _wheel(made, one, "large_sun", (near, BASE + 4), up=True)
    _wheel(made, one, "small_sun", (far, BASE), up=True)
    _wheel(made, one, "ring", (near, made.top), up=False)
    web = (made.width, long), (made.width, short)
    _pin(made, (one.name, "carrier"), one.members["carrier"], (near, long), (web, (web[1], (far, short))))
    return made
