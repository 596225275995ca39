"""Symbols of vehicles and roads."""

from __future__ import annotations

from math import pi, sin

from clutchwork.schematic.look import BLANK, BODY, INK, SIGNAL_BODY, THIN, MarkStyle
from clutchwork.schematic.pen import SymbolPen
from clutchwork.schematic.symbols.heat import SLOT
from clutchwork.schematic.symbols.symbol import Drawn, Symbol

WHEEL = MarkStyle(width=1.2, fill="#DDE3EA")
AIR = THIN._replace(colour="#0072B2", width=0.9)


def _joined(pen: SymbolPen, shown: Drawn, half: float) -> None:
    for side in shown.sides.values():
        pen.line((side * half, 0.0), (side * shown.half, 0.0), look=shown.line)


def vehicle(pen: SymbolPen, shown: Drawn) -> None:
    """A car on a road."""
    pen.area((-13.0, -5.0), (-13.0, 0.0), (-8.0, 1.5), (-4.0, 7.0), (5.0, 7.0), (9.0, 1.5), (13.0, 0.0), (13.0, -5.0),
             look=BODY)  # fmt: skip
    for x in (-7.5, 7.5):
        pen.circle(x, -5.0, 3.2, look=WHEEL)
    pen.floor(-15.0, 15.0, -8.8)
    _joined(pen, shown, 13.0)


def grade(pen: SymbolPen, shown: Drawn) -> None:
    """A wedge with a weight on it."""
    pen.area((-10.0, -8.0), (10.0, -8.0), (10.0, 2.0), look=BODY)
    pen.circle(0.0, 1.5, 4.2, look=WHEEL)
    pen.arrow((0.0, -7.5), (0.0, -1.0), 4.0)
    pen.line((0.0, 1.5), (0.0, -5.0))
    _joined(pen, shown, 10.0)


def drag(pen: SymbolPen, shown: Drawn) -> None:
    """Air around a body."""
    pen.area((-7.0, 0.0), (-3.0, 3.0), (5.0, 2.0), (8.0, 0.0), (5.0, -2.0), (-3.0, -3.0), look=BODY)
    for y in (-8.0, -5.0, 5.0, 8.0):
        bend = 1.2 if y > 0 else -1.2
        pen.line(*((-10.0 + k, y + bend * sin(pi * k / 20)) for k in range(0, 21, 2)), look=AIR)
    _joined(pen, shown, 8.0)


def rolling(pen: SymbolPen, shown: Drawn) -> None:
    """A tyre that is flat where it stands."""
    pen.arc(0.0, 0.0, 9.5, -0.3 * pi, 1.3 * pi, look=INK._replace(width=2.4))
    pen.line((-5.6, -7.7), (5.6, -7.7), look=INK._replace(width=2.4))
    pen.circle(0.0, 0.0, 2.0, look=BLANK)
    pen.floor(-13.0, 13.0, -9.2)
    _joined(pen, shown, 10.0)


def road(pen: SymbolPen, _: Drawn) -> None:
    """Hills."""
    pen.box(-11.0, -8.0, 11.0, 8.0, look=SLOT)
    pen.line((-9.0, -4.0), (-4.0, -4.0), (1.0, 3.5), (5.0, 1.0), (9.0, 5.0), look=SIGNAL_BODY._replace(width=1.4))


def contact(pen: SymbolPen, shown: Drawn) -> None:
    """A wheel on the road that may slide."""
    pen.circle(0.0, 0.0, 11.0, look=WHEEL)
    pen.circle(0.0, 0.0, 2.0, look=BLANK)
    pen.floor(-14.0, 14.0, -14.4)
    for x in (-4.0, 0.0, 4.0):
        pen.line((x - 1.4, -13.8), (x + 1.4, -11.6), look=THIN)
    for port in ("shaft", "mass"):
        if port in shown.sides:
            pen.line((0.0, 0.0), (shown.sides[port] * shown.half, 0.0), look=shown.line)
    if "support" in shown.sides:
        side = shown.sides["support"]
        pen.line((0.0, 0.0), (0.0, 16.0), (side * shown.half, 16.0), look=shown.line)


def driver(pen: SymbolPen, _: Drawn) -> None:
    """A steering wheel."""
    pen.box(-11.0, -8.0, 11.0, 8.0, look=SLOT)
    pen.circle(0.0, 0.0, 6.0, look=SIGNAL_BODY._replace(width=1.6))
    pen.circle(0.0, 0.0, 1.6, look=SIGNAL_BODY)
    pen.line((-6.0, 0.0), (-1.6, 0.0), look=SIGNAL_BODY)
    pen.line((1.6, 0.0), (6.0, 0.0), look=SIGNAL_BODY)
    pen.line((0.0, -1.6), (0.0, -6.0), look=SIGNAL_BODY)


def valve(pen: SymbolPen, _: Drawn) -> None:
    """A coil that moves a spool."""
    pen.box(-11.0, -8.0, 11.0, 8.0, look=SLOT)
    pen.box(-9.0, -4.0, -3.0, 4.0, look=SIGNAL_BODY)
    pen.line((-9.0, -4.0), (-3.0, 4.0), look=SIGNAL_BODY)
    pen.box(-1.0, -5.0, 9.0, 5.0, look=SIGNAL_BODY)
    pen.arrow((4.0, 4.0), (0.0, 1.0), 3.4, look=SIGNAL_BODY)
    pen.line((4.0, -5.0), (4.0, 2.0), look=SIGNAL_BODY)


def actuator(pen: SymbolPen, shown: Drawn) -> None:
    """A piston with its spring and an orifice before it."""
    pen.box(-11.0, -8.0, 11.0, 8.0, look=SLOT)
    pen.line((-9.0, 2.0), (-7.0, 0.0), (-9.0, -2.0), look=SIGNAL_BODY)
    pen.line((-5.0, 2.0), (-7.0, 0.0), (-5.0, -2.0), look=SIGNAL_BODY)
    pen.box(-3.0, -5.0, 9.0, 5.0, look=SIGNAL_BODY)
    pen.box(-1.0, -5.0, 1.0, 5.0, look=SIGNAL_BODY)
    pen.line((1.0, 2.0), (2.5, 4.0), (4.0, 0.0), (5.5, 4.0), (7.0, 0.0), (9.0, 2.0), look=SIGNAL_BODY)
    _joined(pen, shown, 11.0)


VEHICLES = {
    "rolling_contact": Symbol(contact, 18.0, 17.0, 17.0, {"support": 16.0}),
    "driver": Symbol(driver, 12.0, 9.0, 9.0),
    "pressure_valve": Symbol(valve, 12.0, 9.0, 9.0),
    "clutch_actuator": Symbol(actuator, 12.0, 9.0, 9.0),
    "vehicle": Symbol(vehicle, 18.0, 10.0, 10.0),
    "grade": Symbol(grade, 15.0, 9.0, 9.0),
    "air_drag": Symbol(drag, 15.0, 10.0, 10.0),
    "rolling_resistance": Symbol(rolling, 15.0, 11.0, 11.0),
    "road": Symbol(road, 12.0, 9.0, 9.0),
}
