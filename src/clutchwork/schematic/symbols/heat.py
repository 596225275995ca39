"""Symbols of thermal nodes and heat flows, and of what drives contacts: actuators, wear."""

from __future__ import annotations

from math import cos, pi, sin

from clutchwork.schematic.look import HEAT, PAPER, SIGNAL_BODY, WARM, MarkStyle
from clutchwork.schematic.pen import SymbolPen
from clutchwork.schematic.symbols.symbol import Drawn, Symbol

FILLED = WARM._replace(fill=PAPER)
SLOT = SIGNAL_BODY._replace(fill=PAPER)
LIGHT = "#F9DEDC"


def _ends(pen: SymbolPen, shown: Drawn, half: float) -> None:
    for side in shown.sides.values():
        pen.line((side * half, 0.0), (side * shown.half, 0.0), look=HEAT)


def conduction(pen: SymbolPen, shown: Drawn) -> None:
    """A wall."""
    pen.box(-7.0, -7.0, 7.0, 7.0, look=FILLED)
    pen.hatched(-7.0, -7.0, 7.0, 7.0, look=WARM._replace(width=0.5))
    _ends(pen, shown, 7.0)


def convection(pen: SymbolPen, shown: Drawn) -> None:
    """Air that passes a wall."""
    pen.box(-8.0, -7.0, -5.0, 7.0, look=WARM._replace(fill=LIGHT))
    for y in (-4.6, 0.0, 4.6):
        wave = [(-2.5 + 0.6 * k, y + 1.3 * sin(0.2 * pi * k)) for k in range(13)]
        pen.line(*wave, look=WARM._replace(width=0.9))
        pen.arrow((8.0, y), (1.0, 0.0), 3.0, look=WARM)
    _ends(pen, shown, 8.0)


def oil(pen: SymbolPen, shown: Drawn) -> None:
    """A drop."""
    pen.box(-7.5, -8.5, 7.5, 8.5, look=FILLED)
    angles = [0.16 * pi - 0.066 * pi * k for k in range(21)]
    drop = [(4.2 * cos(angle), 4.2 * sin(angle) - 2.4) for angle in angles]
    pen.area((0.0, 7.0), *drop, look=WARM._replace(fill=LIGHT))
    _ends(pen, shown, 7.5)


def plate(pen: SymbolPen, shown: Drawn) -> None:
    """A plate in layers."""
    pen.box(-9.0, -9.0, 9.0, 9.0, look=WARM._replace(fill=LIGHT))
    for x in (-5.0, -1.0, 3.0):
        pen.line((x, -9.0), (x, 9.0), look=WARM._replace(width=0.6))
    _ends(pen, shown, 9.0)


def piston(pen: SymbolPen, _: Drawn) -> None:
    """A cylinder with its piston and the return spring."""
    pen.line((9.0, 6.0), (-9.0, 6.0), (-9.0, -6.0), (9.0, -6.0), look=SIGNAL_BODY)
    pen.box(-2.5, -5.4, 0.5, 5.4, look=SIGNAL_BODY._replace(fill="#E6DDF0"))
    pen.line((0.5, 0.0), (12.0, 0.0), look=SIGNAL_BODY._replace(width=1.6))
    pen.line((1.0, 3.0), (3.0, 5.0), (5.0, 1.6), (7.0, 5.0), (8.5, 3.0), look=SIGNAL_BODY._replace(width=0.7))


def diaphragm(pen: SymbolPen, _: Drawn) -> None:
    """The fingers of a diaphragm spring."""
    pen.box(-11.0, -8.0, 11.0, 8.0, look=SLOT)
    for sign in (1.0, -1.0):
        pen.line((-5.0, sign * 6.5), (5.0, sign * 1.4), look=SIGNAL_BODY._replace(width=1.8))
        pen.circle(-2.0, sign * 5.0, 1.0, look=SIGNAL_BODY)


def weights(pen: SymbolPen, _: Drawn) -> None:
    """Two masses that go outwards."""
    pen.box(-11.0, -9.0, 11.0, 9.0, look=SLOT)
    pen.line((-9.0, 0.0), (9.0, 0.0), look=SIGNAL_BODY)
    for sign in (1.0, -1.0):
        pen.line((-4.0, 0.0), (3.0, sign * 5.0), look=SIGNAL_BODY)
        pen.circle(3.0, sign * 5.0, 2.2, look=SIGNAL_BODY._replace(fill="#E6DDF0"))


def wear(pen: SymbolPen, _: Drawn) -> None:
    """A lining that gets thinner."""
    pen.box(-11.0, -8.0, 11.0, 8.0, look=SLOT)
    pen.area((-8.0, -6.0), (8.0, -6.0), (8.0, 0.0), (4.0, 1.2), (0.0, 0.0), (-4.0, 1.6), (-8.0, 0.2),
             look=SIGNAL_BODY._replace(fill="#E6DDF0", width=0.7))  # fmt: skip
    pen.line((-8.0, 5.0), (8.0, 5.0), look=SIGNAL_BODY._replace(dash="dash", width=0.7))


def process(pen: SymbolPen, _: Drawn) -> None:
    """Symbol of any other process: an integrator."""
    pen.box(-11.0, -8.0, 11.0, 8.0, look=SLOT)
    pen.text(0.0, -3.4, "∫", 10.0, SIGNAL_BODY.colour)


def flow(pen: SymbolPen, shown: Drawn) -> None:
    """Any other heat flow."""
    pen.box(-7.5, -7.5, 7.5, 7.5, look=FILLED)
    pen.arrow((5.0, 0.0), (1.0, 0.0), 4.5, look=WARM)
    pen.line((-5.0, 0.0), (2.0, 0.0), look=WARM)
    _ends(pen, shown, 7.5)


def capacity(pen: SymbolPen, _: Drawn) -> None:
    """A mass that holds heat."""
    pen.box(-8.0, -9.0, 8.0, 9.0, look=MarkStyle(WARM.colour, 1.2, LIGHT))
    pen.line((-3.0, 0.0), (-3.0, -4.6), look=WARM._replace(width=1.6))
    pen.arc(-3.0, -5.0, 1.8, 0.0, 2 * pi, look=WARM._replace(fill=WARM.colour))
    pen.line((-4.6, -3.4), (-4.6, 6.0), (-1.4, 6.0), (-1.4, -3.4), look=WARM._replace(width=0.7))
    for y in (-1.0, 2.0, 5.0):
        pen.line((0.6, y), (3.6, y), look=WARM._replace(width=0.7))


def ambient(pen: SymbolPen, _: Drawn) -> None:
    """Surroundings, which have no end."""
    pen.arc(-4.5, -1.0, 5.0, 0.45 * pi, 1.5 * pi, look=WARM)
    pen.arc(0.5, 2.5, 5.5, 0.08 * pi, 0.9 * pi, look=WARM)
    pen.arc(5.0, -1.8, 4.2, -0.5 * pi, 0.5 * pi, look=WARM)
    pen.line((-4.5, -6.0), (5.0, -6.0), look=WARM)


def source(pen: SymbolPen, shown: Drawn) -> None:
    """Heat that an element makes."""
    for x in (-4.0, 0.0, 4.0):
        wave = [(x + 1.3 * sin(0.25 * pi * k), -5.0 + 0.9 * k) for k in range(10)]
        pen.line(*wave, look=WARM._replace(width=0.9))
        pen.arrow((x, 7.0), (0.0, 1.0), 3.2, look=WARM)
    _ends(pen, shown, 6.0)


FLOWS = {
    "conduction": Symbol(conduction, 12.0, 8.0, 8.0),
    "convection": Symbol(convection, 13.0, 8.0, 8.0),
    "oil_flow": Symbol(oil, 12.0, 9.0, 9.0),
    "thermal_plate": Symbol(plate, 9.0, 10.0, 10.0),
}


def battery(pen: SymbolPen, _: Drawn) -> None:
    """Two cells of plates."""
    for x in (-6.0, 3.0):
        pen.line((x, -8.0), (x, 8.0))
        pen.line((x + 3.0, -4.0), (x + 3.0, 4.0))
    pen.line((-3.0, 0.0), (3.0, 0.0))
    pen.line((-12.0, 0.0), (-6.0, 0.0))
    pen.line((6.0, 0.0), (12.0, 0.0))


PROCESSES = {
    "battery": Symbol(battery, 12.0, 9.0, 9.0),
    "pressure_actuator": Symbol(piston, 13.0, 7.0, 7.0),
    "diaphragm_spring": Symbol(diaphragm, 12.0, 9.0, 9.0),
    "flyweights": Symbol(weights, 12.0, 10.0, 10.0),
    "wear": Symbol(wear, 12.0, 9.0, 9.0),
}
FLOW, PROCESS = Symbol(flow, 12.0, 8.0, 8.0), Symbol(process, 12.0, 9.0, 9.0)
CAPACITY, AMBIENT, SOURCE = Symbol(capacity, 8.0, 10.0, 10.0), Symbol(ambient, 9.4, 9.0, 8.0), Symbol(source, 10.0)
