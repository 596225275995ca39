"""Symbols of gears: what meshes is drawn as in the schematics of gearboxes, in half a section."""

from __future__ import annotations

from contextlib import suppress
from math import isfinite
from typing import Any

from clutchwork.schematic.look import BODY, GREY, INK, LOCKED, OPEN, PLATE, SHAFT, STATE, THIN, TINY, MarkStyle
from clutchwork.schematic.pen import SymbolPen
from clutchwork.schematic.symbols.contacts import CONTACTS, halo, ink, lining
from clutchwork.schematic.symbols.symbol import LEFT, RIGHT, Drawn, Symbol, wall

# rows of a planetary set
RING, CARRIER, SUN = 17.0, 0.0, -17.0
TOOTH = MarkStyle(width=1.8)
PITCH = 26.0  # distance of the axes of a pair


def out(pen: SymbolPen, shown: Drawn, port: str, start: float, letter: str = "") -> None:
    """The line of a port from the middle to its side, or to the housing."""
    y = shown.pins.get(port, 0.0)
    side = shown.sides.get(port)
    if side is None:
        if port in shown.fixed:
            wall(pen, RIGHT, start, shown, y, 6.0)
        return
    pen.line((start if side == RIGHT else -start, y), (side * shown.half, y), look=shown.line)
    if letter:
        pen.text(side * (shown.half - 4.5), y + 1.8, letter, TINY, GREY)


def planetary(pen: SymbolPen, shown: Drawn) -> None:
    """Ring, planet on its carrier, sun."""
    pen.line((0.0, -7.5), (0.0, 7.5), look=TOOTH)
    for y in (-7.5, 7.5):
        pen.line((-5.0, y), (5.0, y), look=TOOTH)
    for y, end in ((9.9, RING), (-9.9, SUN)):
        pen.line((-5.0, y), (5.0, y), look=TOOTH)
        pen.line((0.0, y), (0.0, end), look=TOOTH)
    _members(pen, shown, 0.0)


def double_planetary(pen: SymbolPen, shown: Drawn) -> None:
    """The same with two planets that mesh."""
    for x, low, high in ((-5.5, -7.5, 4.0), (5.5, -4.0, 7.5)):
        pen.line((x, low), (x, high), look=TOOTH)
        for y in (low, high):
            pen.line((x - 4.0, y), (x + 4.0, y), look=TOOTH)
    pen.line((-1.5, 4.0), (-1.5, -4.0), look=THIN)
    pen.line((1.5, 4.0), (1.5, -4.0), look=THIN)
    for x, y, end in ((5.5, 9.9, RING), (-5.5, -9.9, SUN)):
        pen.line((x - 4.0, y), (x + 4.0, y), look=TOOTH)
        pen.line((x, y), (x, end), (0.0, end), look=TOOTH)
    pen.line((-5.5, 0.0), (5.5, 0.0), look=TOOTH)
    _members(pen, shown, 5.5)


def compound_planetary(pen: SymbolPen, shown: Drawn) -> None:
    """Ring, sun, and between them two wheels of a planet on one pin."""
    for x, tall in ((-4.5, 7.5), (4.5, 4.5)):
        pen.line((x, -tall), (x, tall), look=TOOTH)
        for y in (-tall, tall):
            pen.line((x - 3.0, y), (x + 3.0, y), look=TOOTH)
    pen.line((-4.5, 0.0), (4.5, 0.0), look=TOOTH)
    for x, y, end in ((4.5, 6.9, RING), (-4.5, -9.9, SUN)):
        pen.line((x - 3.0, y), (x + 3.0, y), look=TOOTH)
        pen.line((x, y), (x, end), (0.0, end), look=TOOTH)
    _members(pen, shown, 0.0)


def ravigneaux(pen: SymbolPen, shown: Drawn) -> None:
    """Ring, long planet with the large sun, short planet with the small one."""
    pins = shown.pins
    pen.line((-7.0, 3.0), (9.0, 3.0), look=TOOTH)
    for x, low, high in ((-6.0, -3.0, 9.0), (6.0, -4.5, 1.0)):
        pen.line((x, low), (x, high), look=TOOTH)
        for y in (low, high):
            pen.line((x - 3.0, y), (x + 3.0, y), look=TOOTH)
    for x, y, port in ((-6.0, 11.4, "ring"), (-6.0, -5.4, "large_sun"), (6.0, -6.9, "small_sun")):
        pen.line((x - 3.0, y), (x + 3.0, y), look=TOOTH)
        pen.line((x, y), (x, pins.get(port, 0.0)), (0.0, pins.get(port, 0.0)), look=TOOTH)
    pen.circle(-6.0, 3.0, 1.5, look=INK._replace(fill=INK.colour))
    pen.line((0.0, 3.0), (0.0, pins.get("carrier", 0.0)), look=TOOTH)
    for port, letter in (("ring", "R"), ("carrier", "C"), ("large_sun", "L"), ("small_sun", "S")):
        out(pen, shown, port, 0.0, letter)


def chain(pen: SymbolPen, shown: Drawn) -> None:
    """Two sprockets with a chain around them."""
    for y in (PITCH / 2, -PITCH / 2):
        pen.circle(0.0, y, 6.0, look=MarkStyle(width=1.2, fill="#DDE3EA"))
    for x in (-6.0, 6.0):
        pen.line((x, PITCH / 2), (x, -PITCH / 2), look=INK._replace(width=1.6, dash="dash"))
    for y, port in ((PITCH / 2, "input"), (-PITCH / 2, "output")):
        out(pen, shown, port, 0.0)
        if port in shown.fixed:
            wall(pen, RIGHT, 0.0, shown, y, 6.0)
    out(pen, shown, "support", 0.0)


def belt(pen: SymbolPen, shown: Drawn) -> None:
    """Two pulleys with a belt around them."""
    halo(pen, shown)
    for y in (PITCH / 2, -PITCH / 2):
        pen.circle(0.0, y, 6.0, look=MarkStyle(width=1.2, fill="#DDE3EA"))
    crossed = -1.0 if getattr(shown.element, "crossed", False) else 1.0
    for x in (-6.0, 6.0):
        pen.line((x, PITCH / 2), (x * crossed, -PITCH / 2), look=ink(shown, 1.6))
    for port in ("base", "follower"):
        out(pen, shown, port, 0.0)


def _members(pen: SymbolPen, shown: Drawn, axle: float) -> None:
    pen.circle(-axle, CARRIER, 1.5, look=INK._replace(fill=INK.colour))
    if axle:
        pen.circle(axle, CARRIER, 1.5, look=INK._replace(fill=INK.colour))
    out(pen, shown, "ring", 0.0, "R")
    out(pen, shown, "carrier", axle, "C")
    out(pen, shown, "sun", 0.0, "S")


def ratio_of(gear: Any) -> float | None:
    """Ratio of a pair, where it makes sense."""
    with suppress(Exception):
        ratio = float(gear.exact_ratio())
        return ratio if isfinite(ratio) and ratio else None
    return None


def pair(pen: SymbolPen, shown: Drawn) -> None:
    """Two wheels that mesh, sized by their ratio."""
    ratio = abs(ratio_of(shown.element) or 1.0)
    first = min(max(PITCH / (1.0 + ratio), 6.0), PITCH - 6.0)
    top, bottom = PITCH / 2, -PITCH / 2
    mesh = top - first
    for low, high in ((mesh + 0.9, top + first), (bottom - (PITCH - first), mesh - 0.9)):
        pen.box(-3.2, low, 3.2, high, look=BODY)
    for y, port in ((top, "input"), (bottom, "output")):
        pen.line((-5.2, y), (5.2, y), look=shown.line)
        side = shown.sides.get(port)
        if side is None:
            wall(pen, LEFT if port == "input" else RIGHT, 0.0, shown, y, 6.0)
        else:
            pen.line((0.0, y), (side * shown.half, y), look=shown.line)
    if "support" in shown.sides:
        side = shown.sides["support"]
        pen.line((0.0, 0.0), (side * shown.half, 0.0), look=shown.line)
        pen.circle(0.0, 0.0, 1.5, look=INK._replace(fill=INK.colour))


def wheel(pen: SymbolPen, shown: Drawn) -> None:
    """A wheel on the road."""
    pen.circle(0.0, 0.0, 12.0, look=MarkStyle(width=1.6, fill="#DDE3EA"))
    pen.circle(0.0, 0.0, 2.0, look=INK._replace(fill=INK.colour))
    pen.floor(-15.0, 15.0, -12.6)
    for port in ("shaft", "mass"):
        side = shown.sides.get(port)
        if side is not None:
            look = SHAFT if port == "shaft" else SHAFT._replace(colour="#0B5D46")
            pen.line((0.0, 0.0), (side * shown.half, 0.0), look=look)
    if "support" in shown.sides:
        side = shown.sides["support"]
        pen.line((0.0, 0.0), (0.0, 16.0), (side * shown.half, 16.0), look=SHAFT)


def dogs(pen: SymbolPen, shown: Drawn) -> None:
    """Two faces with teeth: in mesh where they hold."""
    halo(pen, shown)
    dark = ink(shown, 1.8)
    depth = 3.0 if shown.state == LOCKED else 0.0
    left, right = -5.5 + depth / 2, 5.5 - depth / 2
    pen.line((left, -11.0), (left, 11.0), look=dark)
    pen.line((right, -11.0), (right, 11.0), look=dark)
    fill = dark._replace(width=0.5, fill=dark.colour)
    for y in (-9.5, -2.0, 5.5):
        pen.box(left, y, left + 4.0, y + 3.4, look=fill)
        pen.box(right - 4.0, y + 3.8, right, y + 6.8, look=fill)
    pen.line((-shown.half, 0.0), (left, 0.0), look=shown.line) if LEFT in shown.sides.values() else wall(
        pen, LEFT, left, shown
    )
    pen.line((right, 0.0), (shown.half, 0.0), look=shown.line) if RIGHT in shown.sides.values() else wall(
        pen, RIGHT, right, shown
    )


def synchroniser(pen: SymbolPen, shown: Drawn) -> None:
    """A sleeve between two gears, each with a cone and teeth."""
    box = BODY._replace(fill="#F3F5F8", colour=STATE[shown.state].colour if shown.state != OPEN else INK.colour)
    pen.box(-12.0, -20.0, 12.0, 20.0, look=box)
    pen.box(-3.0, -4.5, 3.0, 4.5, look=PLATE._replace(width=1.4, fill="#DDE3EA"))
    for sign, port in ((1.0, "forward"), (-1.0, "backward")):
        if port in shown.sides or port in shown.fixed:
            pen.line((-7.0, sign * 9.0), (7.0, sign * 9.0), look=TOOTH)
            pen.line((-7.0, sign * 9.0), (-5.0, sign * 6.0), look=TOOTH)
            pen.line((7.0, sign * 9.0), (5.0, sign * 6.0), look=TOOTH)
            low, high = sorted((sign * 5.0, sign * 8.0))
            if shown.state and f"{port}:{shown.state}" in shown.parts:
                lining(pen, shown, -4.0, low, 4.0, high)
            pen.line((0.0, sign * 9.0), (0.0, shown.pins[port]), look=shown.line)
            out(pen, shown, port, 0.0)
    pen.line((0.0, 0.0), (0.0, 0.0), look=shown.line)
    out(pen, shown, "hub", 3.0)


def transmission(pen: SymbolPen, shown: Drawn) -> None:
    """A housing with a row of sets in it."""
    pen.box(-18.0, -15.0, 18.0, 15.0, look=BODY._replace(fill="#F3F5F8"))
    for x in (-9.0, 0.0, 9.0):
        for sign in (1.0, -1.0):
            pen.line((x, sign * 4.0), (x, sign * 8.5), look=TOOTH)
            for y in (4.0, 8.5):
                pen.line((x - 2.6, sign * y), (x + 2.6, sign * y), look=TOOTH)
            pen.line((x - 2.6, sign * 10.9), (x + 2.6, sign * 10.9), look=TOOTH)
    for port, start in (("input", 18.0), ("output", 18.0)):
        out(pen, shown, port, start)


PAIR = {"input": PITCH / 2, "output": -PITCH / 2, "support": 0.0}
SETS = {"ring": RING, "carrier": CARRIER, "sun": SUN}

GEARS = {
    "gear": Symbol(pair, 16.0, 33.0, 33.0, PAIR),
    "planetary": Symbol(planetary, 20.0, 22.0, 22.0, SETS),
    "double_planetary": Symbol(double_planetary, 22.0, 22.0, 22.0, SETS),
    "bevel_gear": Symbol(pair, 16.0, 33.0, 33.0, PAIR),
    "belt_contact": CONTACTS["clutch"],
    "belt_drive": Symbol(belt, 16.0, 20.0, 20.0, {"base": PITCH / 2, "follower": -PITCH / 2}),
    "chain": Symbol(chain, 16.0, 20.0, 20.0, PAIR),
    "compound_planetary": Symbol(compound_planetary, 20.0, 22.0, 22.0, SETS),
    "ravigneaux": Symbol(
        ravigneaux, 20.0, 24.0, 28.0, {"ring": 19.0, "carrier": 6.0, "large_sun": -9.0, "small_sun": -22.0}
    ),
    "polygon_sprocket": Symbol(wheel, 18.0, 16.0, 17.0, {"support": 16.0}),
    "rolling_wheel": Symbol(wheel, 18.0, 16.0, 17.0, {"support": 16.0}),
    "dog_clutch": Symbol(dogs),
    "transmission": Symbol(transmission, 24.0, 16.0, 16.0),
    "synchroniser": Symbol(synchroniser, 18.0, 21.0, 21.0, {"hub": 0.0, "forward": 14.0, "backward": -14.0}),
}
