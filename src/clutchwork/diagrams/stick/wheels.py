"""Wheels of gear sets: bars with stems, planets on their pins, what is fixed to the housing, teeth and names."""

from __future__ import annotations

from clutchwork.diagrams.marks import GREY, HELD, IDLE, INK, NAME, PAPER, POWER, SMALL, Pen, Point
from clutchwork.diagrams.stick.bodies import Bar, Body, MemberPiece, Planet
from clutchwork.diagrams.stick.lines import MESH, place
from clutchwork.diagrams.stick.looks import LOST, Scene
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.schematic.pen import Rect

HALF = 8.0  # px, half the width of a wheel
PIN, HATCH = 10.0, 5.0
PINNED = ("carrier", "second")


def draw_body(pen: Pen, scene: Scene, body: Body) -> None:
    """A gear set; the lines of its members are there already."""
    for piece in {piece.root: piece for piece in body.pieces.values()}.values():
        if piece.member == HOUSING:
            _draw_fixed(pen, scene, piece)
    for first, last in body.joined:
        (left, y), (right, _) = scene.at(first), scene.at(last)
        pen.rectangle(Rect(left, y - 3.0, right, y + 3.0), PAPER, _colour(scene, body), 1.3)
    for planet in body.planets:
        _draw_planet(pen, scene, body, planet)
    for bar in body.bars:
        _draw_bar(pen, scene, body, bar)


def draw_names(pen: Pen, scene: Scene, body: Body, below: float) -> None:
    """Teeth beside wheels, the name of the set below it."""
    teeth = {(one.name, name): str(number) for one in scene.box.sets for name, number in one.teeth.items()}
    for bar in body.bars:
        x, y = place(scene, bar.at)
        pen.label(x + HALF + 2.0, y + (3.8 if bar.up else 2.8), teeth.get(bar.source, ""), SMALL, GREY, anchor="start")
    for planet in body.planets:
        x, y = scene.at((planet.at[0] + planet.wide, planet.at[1]))
        pen.label(x + 4.0, y - 9.4, teeth.get(planet.teeth, ""), SMALL, GREY, anchor="start")
    xs = [scene.at(planet.at)[0] for planet in body.planets]
    xs += [scene.at((planet.at[0] + planet.wide, planet.at[1]))[0] for planet in body.planets]
    pen.label(0.5 * (min(xs) + max(xs)), below, body.name.replace("+", " + "), NAME + 0.5, INK, bold=True)


def _colour(scene: Scene, body: Body) -> str:
    """Colour of planets: those that carry power, that turn, that stand."""
    if scene.now is None:
        return INK
    if any(abs(scene.now.set_powers[name][port]) > LOST for name, port in body.pieces):
        return POWER
    members = {piece.member for piece in body.pieces.values()} - {HOUSING}
    return HELD if all(abs(scene.now.speeds[member]) < LOST for member in members) else IDLE


def _draw_bar(pen: Pen, scene: Scene, body: Body, bar: Bar) -> None:
    x, y = place(scene, bar.at)
    piece = body.pieces[bar.source]
    # sets that share planets share wheels
    here = [source for source, other in body.pieces.items() if other.root == piece.root]
    power = sum(scene.now.set_powers[name][port] for name, port in here) if scene.now else 0.0
    what = " ".join(bar.source)
    pen.line((x - HALF, y), (x + HALF, y), colour=scene.colour(piece.member, power), width=2.6, what=what)


def _draw_planet(pen: Pen, scene: Scene, body: Body, planet: Planet) -> None:
    colour = _colour(scene, body)
    x, y = scene.at(planet.at)
    last = scene.at((planet.at[0] + planet.wide, planet.at[1]))[0]
    low, high = scene.at((planet.at[0], planet.low))[1] - MESH, scene.at((planet.at[0], planet.high))[1] + MESH
    for column in dict.fromkeys((x, last)):
        pen.line((column, low), (column, high), colour=colour, width=1.5, what=f"{body.name} planet")
    for row in (low, high):
        pen.line((x - HALF, row), (last + HALF, row), colour=colour, width=2.0, what=f"{body.name} planet")
    (_, turned), pin = next((source, piece) for source, piece in body.pieces.items() if source[1] in PINNED)
    for column in dict.fromkeys((x, last)):
        pen.line((column - PIN, y), (column + PIN, y), colour=scene.colour(pin.member), width=1.5, what=pin.member)
        if turned == "carrier":
            pen.dot(column, y, 2.6, PAPER, colour, 1.2)


def _draw_fixed(pen: Pen, scene: Scene, piece: MemberPiece) -> None:
    """A member of the set that is the housing."""
    start, end = place(scene, piece.root), scene.at(piece.ends[0])
    colour = scene.colour(HOUSING)
    # a carrier is held at one of its ends
    for line in (line for line in piece.lines if len(piece.ends) == 1 or piece.ends[-1] not in line):
        pen.line(place(scene, line[0]), place(scene, line[1]), colour=colour, width=1.5, what=HOUSING)
    if abs(start[0] - end[0]) > abs(start[1] - end[1]):
        away = (-1.0 if end[0] < start[0] else 1.0, 0.0)
        ground(pen, (end[0], end[1] - 10.0), (end[0], end[1] + 10.0), away, colour)
    else:
        away = (0.0, 1.0 if end[1] > start[1] else -1.0)
        ground(pen, (end[0] - 10.0, end[1]), (end[0] + 10.0, end[1]), away, colour)


def ground(pen: Pen, start: Point, end: Point, away: Point, colour: str) -> None:
    """The housing: a line, hatched on the side `away`."""
    long = abs(end[0] - start[0]) + abs(end[1] - start[1])
    count = max(3, round(long / 6.0))
    along = ((end[0] - start[0]) / count, (end[1] - start[1]) / count)
    for number in range(count):
        x, y = start[0] + number * along[0], start[1] + number * along[1]
        tip = (x + along[0] + HATCH * away[0], y + along[1] + HATCH * away[1])
        pen.line((x, y), tip, colour=colour, width=0.8)
    pen.line(start, end, colour=colour, width=2.0, what=HOUSING)
