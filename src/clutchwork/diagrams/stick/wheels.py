"""Wheels of gear sets: bars with stems, planets on their pins, what is fixed to the housing, teeth and names."""

from __future__ import annotations

from clutchwork.diagrams.marks import GREY, HELD, IDLE, INK, NAME, PAPER, POWER, SMALL, Pen, Point
from clutchwork.diagrams.stick.bodies import Bar, Body, Planet
from clutchwork.diagrams.stick.lines import MESH, place
from clutchwork.diagrams.stick.looks import LOST, Scene
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.schematic.pen import Box

HALF = 8.0  # px, half the width of a wheel
PIN, HATCH = 10.0, 5.0


def draw_body(pen: Pen, scene: Scene, body: Body) -> None:
    """A gear set; the lines of its members are there already."""
    for port, piece in body.pieces.items():
        if piece.member == HOUSING:
            _draw_fixed(pen, scene, body, port)
    for first, last in body.joined:
        (left, y), (right, _) = scene.at(first), scene.at(last)
        pen.rectangle(Box(left, y - 3.0, right, y + 3.0), PAPER, _colour(scene, body), 1.3)
    for planet in body.planets:
        _draw_planet(pen, scene, body, planet)
    for bar in body.bars:
        _draw_bar(pen, scene, body, bar)


def draw_names(pen: Pen, scene: Scene, body: Body, below: float) -> None:
    """Teeth beside wheels, the name of the set below it."""
    teeth = next(one.teeth for one in scene.box.sets if one.name == body.name)
    for bar in body.bars:
        x, y = place(scene, bar.at)
        pen.label(
            x + HALF + 2.0, y + (3.8 if bar.up else 2.8), str(teeth.get(bar.port, "")), SMALL, GREY, anchor="start"
        )
    for planet in body.planets:
        x, y = scene.at((planet.at[0] + planet.wide, planet.at[1]))
        pen.label(x + 4.0, y - 9.4, str(teeth.get(planet.teeth, "")), SMALL, GREY, anchor="start")
    xs = [scene.at(planet.at)[0] for planet in body.planets]
    xs += [scene.at((planet.at[0] + planet.wide, planet.at[1]))[0] for planet in body.planets]
    pen.label(0.5 * (min(xs) + max(xs)), below, body.name, NAME + 0.5, INK, bold=True)


def _colour(scene: Scene, body: Body) -> str:
    """Colour of planets: those that carry power, that turn, that stand."""
    if scene.now is None:
        return INK
    if any(abs(power) > LOST for power in scene.now.set_powers[body.name].values()):
        return POWER
    members = {piece.member for piece in body.pieces.values()} - {HOUSING}
    return HELD if all(abs(scene.now.speeds[member]) < LOST for member in members) else IDLE


def _draw_bar(pen: Pen, scene: Scene, body: Body, bar: Bar) -> None:
    x, y = place(scene, bar.at)
    member = body.pieces[bar.port].member
    power = scene.now.set_powers[body.name][bar.port] if scene.now else 0.0
    pen.line(
        (x - HALF, y), (x + HALF, y), colour=scene.colour(member, power), width=2.6, what=f"{body.name} {bar.port}"
    )


def _draw_planet(pen: Pen, scene: Scene, body: Body, planet: Planet) -> None:
    colour = _colour(scene, body)
    x, y = scene.at(planet.at)
    last = scene.at((planet.at[0] + planet.wide, planet.at[1]))[0]
    low, high = scene.at((planet.at[0], planet.low))[1] - MESH, scene.at((planet.at[0], planet.high))[1] + MESH
    for column in dict.fromkeys((x, last)):
        pen.line((column, low), (column, high), colour=colour, width=1.5, what=f"{body.name} planet")
    for row in (low, high):
        pen.line((x - HALF, row), (last + HALF, row), colour=colour, width=2.0, what=f"{body.name} planet")
    pin = body.pieces.get("carrier") or body.pieces["second"]
    for column in dict.fromkeys((x, last)):
        pen.line((column - PIN, y), (column + PIN, y), colour=scene.colour(pin.member), width=1.5, what=pin.member)
        if "carrier" in body.pieces:
            pen.dot(column, y, 2.6, PAPER, colour, 1.2)


def _draw_fixed(pen: Pen, scene: Scene, body: Body, port: str) -> None:
    """A member of the set that is the housing."""
    piece = body.pieces[port]
    start, end = place(scene, piece.root), scene.at(piece.ends[0])
    colour = scene.colour(HOUSING)
    for line in piece.lines if port == "carrier" else ():
        if piece.ends[-1] not in line:
            pen.line(scene.at(line[0]), scene.at(line[1]), colour=colour, width=1.5, what=HOUSING)
    if port != "carrier":
        pen.line(start, end, colour=colour, width=1.5, what=HOUSING)
    if abs(start[0] - end[0]) > abs(start[1] - end[1]):
        ground(pen, (end[0], end[1] - 10.0), (end[0], end[1] + 10.0), (-1.0 if end[0] < start[0] else 1.0, 0.0), colour)
    else:
        ground(pen, (end[0] - 10.0, end[1]), (end[0] + 10.0, end[1]), (0.0, 1.0 if end[1] > start[1] else -1.0), colour)


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
