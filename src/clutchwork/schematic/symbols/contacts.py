"""Symbols of clutches, brakes and freewheels: plates that face each other, in the look of their state."""

from __future__ import annotations

from math import pi

from clutchwork.schematic.look import HALO, LOCKED, PAPER, SLIPPING, STATE, THIN, MarkStyle
from clutchwork.schematic.pen import SymbolPen
from clutchwork.schematic.symbols.symbol import Drawn, Symbol, ends


def ink(shown: Drawn, width: float = 1.0) -> MarkStyle:
    """Lines in the colour of the state."""
    return STATE[shown.state]._replace(width=width)


def halo(pen: SymbolPen, shown: Drawn, width: float = 11.5, height: float = 12.0) -> None:
    """The ground that shows the state from afar."""
    if shown.state in HALO:
        colour = HALO[shown.state]
        pen.box(-width, -height, width, height, look=MarkStyle(colour, 0.4, colour))


def lining(pen: SymbolPen, shown: Drawn, left: float, low: float, right: float, high: float) -> None:
    """What is between two plates: full while locked, hatched while slipping, nothing while open."""
    if shown.state == LOCKED:
        pen.box(left, low, right, high, look=ink(shown, 0.4)._replace(fill=STATE[LOCKED].colour))
    elif shown.state == SLIPPING:
        pen.box(left, low, right, high, look=ink(shown, 0.5)._replace(fill=PAPER))
        pen.hatched(left, low, right, high, look=ink(shown, 0.8))


def clutch(pen: SymbolPen, shown: Drawn) -> None:
    """Two plates."""
    halo(pen, shown)
    lining(pen, shown, -3.2, -9.0, 3.2, 9.0)
    for x in (-4.0, 4.0):
        pen.line((x, -11.0), (x, 11.0), look=ink(shown, 2.2))
    ends(pen, shown, -4.0, 4.0)


def multi_plate(pen: SymbolPen, shown: Drawn) -> None:
    """A pack: plates of one side between those of the other."""
    halo(pen, shown)
    lining(pen, shown, -6.0, -7.5, 6.0, 7.5)
    dark = ink(shown, 1.6)
    for x in (-3.0, 3.0):
        pen.line((x, -8.0), (x, 8.0), look=dark)
    pen.line((-7.5, 0.0), (-7.5, 0.0), look=dark)
    for x in (-6.0, 0.0, 6.0):
        pen.line((x, -11.0), (x, 11.0), look=dark)
    ends(pen, shown, -6.0, 6.0)
    # the basket that carries the outer plates
    pen.line((-6.0, 11.0), (6.0, 11.0), look=dark)
    pen.line((-6.0, -11.0), (6.0, -11.0), look=dark)


def cone(pen: SymbolPen, shown: Drawn) -> None:
    """Two slanted faces, above and below the axis."""
    halo(pen, shown)
    for sign in (1.0, -1.0):
        pen.line((-6.0, sign * 3.0), (2.0, sign * 10.0), look=ink(shown, 2.2))
        pen.line((-2.0, sign * 1.5), (6.0, sign * 8.5), look=ink(shown, 2.2))
        if shown.state == LOCKED:
            filled = ink(shown, 0.4)._replace(fill=STATE[LOCKED].colour)
            points = ((-6.0, 3.0), (2.0, 10.0), (6.0, 8.5), (-2.0, 1.5))
            pen.area(*((x, sign * y) for x, y in points), look=filled)
        if shown.state == SLIPPING:
            for k in range(5):
                x = -5.5 + 1.8 * k
                pen.line((x, sign * (3.4 + 1.55 * k)), (x + 3.4, sign * (1.9 + 1.55 * k)), look=ink(shown, 0.8))
    pen.line((-6.0, -3.0), (-6.0, 3.0), look=ink(shown, 1.4))
    pen.line((6.0, -8.5), (6.0, 8.5), look=ink(shown, 1.4))
    ends(pen, shown, -6.0, 6.0)


def freewheel(pen: SymbolPen, shown: Drawn) -> None:
    """Two rings and a wedge that points from what drives to what may run ahead."""
    halo(pen, shown)
    full = ink(shown, 1.0)._replace(fill=STATE[LOCKED].colour if shown.state == LOCKED else PAPER)
    pen.area((-6.0, -7.5), (6.0, 0.0), (-6.0, 7.5), look=full)
    if shown.state == SLIPPING:
        pen.hatched(-6.0, -3.0, 0.0, 3.0, look=ink(shown, 0.8))
    pen.line((6.0, -10.0), (6.0, 10.0), look=ink(shown, 2.2))
    pen.line((-6.0, -10.0), (-6.0, 10.0), look=ink(shown, 2.2))
    ends(pen, shown, -6.0, 6.0)


def sprag(pen: SymbolPen, shown: Drawn) -> None:
    """A freewheel with the sprags drawn."""
    freewheel(pen, shown)
    for x in (-4.5, -0.5):
        pen.line((x, 8.6), (x + 3.0, 11.5), look=ink(shown, 1.2))


def limiter(pen: SymbolPen, shown: Drawn) -> None:
    """Two plates that a spring presses together."""
    clutch(pen, shown)
    pen.line((-15.0, 8.0), (-12.6, 8.0), (-11.6, 10.5), (-9.8, 5.5), (-8.0, 10.5), (-7.0, 8.0), look=ink(shown, 0.9))
    pen.arrow((-4.8, 8.0), (1.0, 0.0), 3.0, look=ink(shown))


def centrifugal(pen: SymbolPen, shown: Drawn) -> None:
    """A drum, and shoes that go outwards."""
    halo(pen, shown)
    pen.line((6.0, -11.0), (6.0, 11.0), look=ink(shown, 2.2))
    for sign in (1.0, -1.0):
        pen.line((6.0, sign * 11.0), (-6.0, sign * 11.0), look=ink(shown, 2.2))
        lining(pen, shown, -5.0, min(sign * 7.6, sign * 9.9), 4.0, max(sign * 7.6, sign * 9.9))
        pen.box(-5.0, sign * 7.4 - 1.2, 3.0, sign * 7.4 + 1.2, look=ink(shown, 0.8)._replace(fill="#DDE3EA"))
        pen.line((-2.0, 0.0), (-2.0, sign * 4.0), look=ink(shown, 0.9))
        pen.arrow((-2.0, sign * 6.0), (0.0, sign), 3.0, look=ink(shown))
    ends(pen, shown, -1.5, 6.0)


def disc_brake(pen: SymbolPen, shown: Drawn) -> None:
    """A disc between two pads."""
    halo(pen, shown)
    pen.line((0.0, -11.0), (0.0, 9.0), look=ink(shown, 2.2))
    for sign in (1.0, -1.0):
        lining(pen, shown, min(sign * 1.2, sign * 4.0), 2.0, max(sign * 1.2, sign * 4.0), 9.0)
        pen.box(sign * 4.5 - 1.6, 2.0, sign * 4.5 + 1.6, 9.0, look=ink(shown, 1.0)._replace(fill="#DDE3EA"))
    pen.line((-4.5, 9.0), (-4.5, 12.0), (8.0, 12.0), (8.0, 0.0), look=ink(shown, 1.4))
    pen.line((4.5, 9.0), (4.5, 12.0), look=ink(shown, 1.4))
    ends(pen, shown, 0.0, 8.0)


def drum_brake(pen: SymbolPen, shown: Drawn) -> None:
    """A drum with two shoes inside."""
    halo(pen, shown)
    pen.circle(0.0, 0.0, 10.0, look=ink(shown, 1.8)._replace(fill=PAPER))
    lining(pen, shown, -2.5, 6.2, 2.5, 9.0)
    lining(pen, shown, -2.5, -9.0, 2.5, -6.2)
    for start in (0.2 * pi, 1.2 * pi):
        pen.arc(0.0, 0.0, 7.0, start, start + 0.6 * pi, look=ink(shown, 2.2))
    ends(pen, shown, -10.0, 10.0)


def band_brake(pen: SymbolPen, shown: Drawn) -> None:
    """A drum with a band around it."""
    halo(pen, shown)
    pen.circle(0.0, 0.0, 7.0, look=ink(shown, 1.4)._replace(fill="#DDE3EA"))
    lining(pen, shown, -3.0, 7.2, 3.0, 9.4)
    pen.arc(0.0, 0.0, 9.6, -0.25 * pi, 1.25 * pi, look=ink(shown, 2.0))
    pen.arrow((-9.6, -11.0), (-0.5, -0.86), 3.4, look=ink(shown))
    ends(pen, shown, -7.0, 9.6)


def bearing(pen: SymbolPen, shown: Drawn) -> None:
    """A shaft between two blocks of the housing."""
    halo(pen, shown, 11.5, 11.0)
    for sign in (1.0, -1.0):
        low, high = sorted((sign * 2.4, sign * 7.4))
        lining(pen, shown, -7.0, min(sign * 1.0, sign * 2.6), 7.0, max(sign * 1.0, sign * 2.6))
        pen.box(-7.0, low, 7.0, high, look=ink(shown, 0.9)._replace(fill=PAPER))
        pen.hatched(-7.0, low, 7.0, high, look=THIN)
    ends(pen, shown, 10.0 if -1 in shown.sides.values() else -8.0, 8.0 if 1 in shown.sides.values() else 10.0)


CONTACTS = {
    "clutch": Symbol(clutch),
    "plate_contact": Symbol(clutch),
    "fundamental_clutch": Symbol(clutch),
    "brake": Symbol(clutch),
    "disk_clutch": Symbol(multi_plate),
    "cone_clutch": Symbol(cone),
    "one_way_clutch": Symbol(freewheel),
    "sprag_clutch": Symbol(sprag),
    "torque_limiter": Symbol(limiter),
    "centrifugal_clutch": Symbol(centrifugal),
    "disk_brake": Symbol(disc_brake),
    "double_shoe_brake": Symbol(drum_brake),
    "band_brake": Symbol(band_brake),
    "bearing_friction": Symbol(bearing),
}
