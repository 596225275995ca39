"""Symbols of ratios that vary."""

from __future__ import annotations

from clutchwork.schematic.look import BODY, INK, MASS, SHAFT, THIN, MarkStyle
from clutchwork.schematic.pen import SymbolPen
from clutchwork.schematic.symbols.gears import PAIR, PITCH
from clutchwork.schematic.symbols.symbol import LEFT, RIGHT, Drawn, Symbol, wall

PIN = INK._replace(fill=INK.colour)


def variable(pen: SymbolPen, shown: Drawn) -> None:
    """Two cones with a belt between them, and the arrow of what can be set."""
    for y, sign in ((PITCH / 2, 1.0), (-PITCH / 2, -1.0)):
        tall = 4.0 + 3.0 * sign
        pen.area((-7.0, y - tall), (-7.0, y + tall), (7.0, y + 11.0 - tall), (7.0, y - 11.0 + tall), look=BODY)
    for y in (-7.5, 7.5):
        pen.line((0.0, PITCH / 2 + y * 0.7), (0.0, -PITCH / 2 + y * 0.7), look=MarkStyle(width=1.4))
    pen.line((-11.0, -9.0), (11.0, 9.0), look=THIN)
    pen.arrow((11.0, 9.0), (0.77, 0.63), look=THIN)
    for port in ("input", "output"):
        y, side = shown.pins.get(port, 0.0), shown.sides.get(port)
        if side is None:
            wall(pen, LEFT if port == "input" else RIGHT, 7.0 if port == "output" else -7.0, shown, y, 6.0)
        else:
            pen.line((side * 7.0, y), (side * shown.half, y), look=shown.line)
    if "support" in shown.sides:
        pen.line((0.0, 0.0), (shown.sides["support"] * shown.half, 0.0), look=shown.line)
        pen.circle(0.0, 0.0, 1.5, look=PIN)


def joint(pen: SymbolPen, shown: Drawn) -> None:
    """Two yokes, crossed."""
    for side in (-1.0, 1.0):
        pen.line((side * 9.0, 0.0), (side * 5.0, 7.0 * side), (0.0, 7.0 * side), look=MarkStyle(width=1.8))
        pen.line((side * 9.0, 0.0), (side * 5.0, -7.0 * side), (0.0, -7.0 * side), look=MarkStyle(width=1.8))
    pen.line((0.0, -8.5), (0.0, 8.5), look=MarkStyle(width=1.2))
    pen.circle(0.0, 0.0, 2.4, look=BODY)
    for port in ("base", "follower"):
        end = shown.sides.get(port)
        if end is None:
            wall(pen, LEFT if port == "base" else RIGHT, -9.0 if port == "base" else 9.0, shown)
        else:
            pen.line((end * 9.0, 0.0), (end * shown.half, 0.0), look=shown.line)
    if "support" in shown.sides:
        y, side = shown.pins.get("support", 0.0), shown.sides["support"]
        pen.line((0.0, -8.5), (0.0, y), (side * shown.half, y), look=shown.line)


def _ends(pen: SymbolPen, shown: Drawn, shaft: float) -> None:
    """Lines to the shaft, which begins at a place, and to the mass in its guide."""
    for port, start, look in (("shaft", shaft, SHAFT), ("mass", 14.0, MASS)):
        side = shown.sides.get(port)
        if side is not None:
            pen.line((start if start * side > 0 else 0.0, 0.0), (side * shown.half, 0.0), look=look)


def crank(pen: SymbolPen, shown: Drawn) -> None:
    """A crank, its rod and what it moves in a guide."""
    pen.circle(-8.0, 0.0, 7.0, look=BODY)
    pen.line((-8.0, 0.0), (-4.5, 6.0), look=MarkStyle(width=1.8))
    pen.line((-4.5, 6.0), (9.0, 0.0), look=INK)
    for x, y in ((-8.0, 0.0), (-4.5, 6.0), (9.0, 0.0)):
        pen.circle(x, y, 1.4, look=PIN)
    pen.box(6.0, -4.0, 14.0, 4.0, look=MarkStyle(width=1.2))
    for y in (-5.2, 5.2):
        pen.line((3.0, y), (17.0, y), look=THIN)
    _ends(pen, shown, -8.0)


def cam(pen: SymbolPen, shown: Drawn) -> None:
    """An eccentric disc and what it pushes in a guide."""
    pen.circle(-8.0, 0.0, 7.0, look=BODY)
    pen.circle(-10.5, 0.0, 1.4, look=PIN)
    pen.line((-1.0, -5.0), (-1.0, 5.0), look=MarkStyle(width=1.8))
    pen.line((-1.0, 0.0), (14.0, 0.0), look=INK)
    for y in (-2.6, 2.6):
        pen.line((3.0, y), (11.0, y), look=THIN)
    _ends(pen, shown, -10.5)


RATIOS = {
    "variable_gear": Symbol(variable, 18.0, 30.0, 30.0, PAIR),
    "variable_ratio": Symbol(variable, 18.0, 30.0, 30.0, PAIR),
    "universal_joint": Symbol(joint, 18.0, 12.0, 18.0, {"support": -14.0}),
    "crank_slider": Symbol(crank, 20.0, 12.0, 12.0),
    "cam": Symbol(cam, 20.0, 12.0, 12.0),
    "cam_profile": Symbol(cam, 20.0, 12.0, 12.0),
}
