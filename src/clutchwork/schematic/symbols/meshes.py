"""Symbols of gears with losses, of worms, screws and racks, and of differentials."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin
from typing import Any

from clutchwork.schematic.look import BODY, INK, PAPER, SIGNAL_BODY, MarkStyle
from clutchwork.schematic.pen import SymbolPen
from clutchwork.schematic.symbols.contacts import halo, ink, lining
from clutchwork.schematic.symbols.gears import PAIR, SETS, out, pair, planetary
from clutchwork.schematic.symbols.heat import SLOT
from clutchwork.schematic.symbols.symbol import Drawn, Symbol

PIN = INK._replace(fill=INK.colour)
STEEL = BODY._replace(width=0.9)
DIFFERENTIAL = {"left": 18.0, "carrier": 0.0, "right": -18.0}
CAGE = 12.0


def efficiency(pen: SymbolPen, shown: Drawn, x: float, y: float) -> None:
    """The letter of an efficiency, in the colour of the state."""
    pen.text(x, y, "η", 8.0, ink(shown).colour)


def with_losses(draw: Callable[[SymbolPen, Drawn], None], x: float, y: float) -> Callable[[SymbolPen, Drawn], None]:
    """A gear, and the letter of an efficiency beside it."""

    def drawn(pen: SymbolPen, shown: Drawn) -> None:
        draw(pen, shown)
        efficiency(pen, shown, x, y)

    return drawn


def rack(pen: SymbolPen, shown: Drawn) -> None:
    """A pinion on a rack."""
    for k in range(12):
        along = (cos(pi * k / 6.0), sin(pi * k / 6.0))
        ends = [(r * along[0], 6.0 + r * along[1]) for r in (8.0, 10.5)]
        pen.line(*ends, look=MarkStyle(width=1.6))
    pen.circle(0.0, 6.0, 8.4, look=STEEL)
    teeth = [
        (-13.0 + 5.2 * k + x, y) for k in range(5) for x, y in ((0.0, -8.0), (1.2, -4.6), (3.0, -4.6), (4.2, -8.0))
    ]
    pen.area((-14.0, -12.0), (-14.0, -8.0), *teeth, (14.0, -8.0), (14.0, -12.0), look=STEEL)
    out(pen, shown, "shaft", 0.0)
    pen.circle(0.0, 6.0, 1.5, look=PIN)
    out(pen, shown, "mass", 14.0)
    if "support" in shown.sides:
        pen.line((0.0, 6.0), (0.0, shown.pins["support"]), look=shown.line)
        out(pen, shown, "support", 0.0)


def threads(pen: SymbolPen, left: float, right: float, y: float, tall: float) -> None:
    """A screw: a bar with slanted threads."""
    pen.box(left, y - tall, right, y + tall, look=STEEL)
    x = left
    while x + 5.0 <= right + 0.01:
        pen.line((x, y - tall - 1.2), (x + 3.0, y + tall + 1.2), look=MarkStyle(width=1.3))
        x += 4.0


def worm(pen: SymbolPen, shown: Drawn) -> None:
    """A screw over a wheel."""
    halo(pen, shown, 13.0, 17.5)
    for k in range(16):
        along = (cos(pi * k / 8.0), sin(pi * k / 8.0))
        pen.line(*((r * along[0], -6.0 + r * along[1]) for r in (8.4, 10.4)), look=MarkStyle(width=1.2))
    pen.circle(0.0, -6.0, 9.0, look=STEEL)
    threads(pen, -11.0, 11.0, shown.pins.get("worm", 9.0), 3.4)
    out(pen, shown, "worm", 11.0)
    out(pen, shown, "wheel", 0.0)
    pen.circle(0.0, -6.0, 1.5, look=PIN)
    if "support" in shown.sides:
        pen.line((0.0, -6.0), (0.0, shown.pins["support"]), look=shown.line)
        out(pen, shown, "support", 0.0)


def leadscrew(pen: SymbolPen, shown: Drawn) -> None:
    """A screw and a nut on it, cut open."""
    halo(pen, shown, 8.0, 10.5)
    threads(pen, -17.0, 17.0, 0.0, 3.2)
    for low, high in ((4.4, 9.0), (-9.0, -4.4)):
        pen.box(-6.0, low, 6.0, high, look=ink(shown, 0.9)._replace(fill=PAPER))
        pen.hatched(-6.0, low, 6.0, high, look=ink(shown, 0.6))
    out(pen, shown, "screw", 17.0)
    pen.line((0.0, -9.0), (0.0, shown.pins.get("mass", 0.0)), look=shown.line)
    out(pen, shown, "mass", 0.0)
    if "support" in shown.sides:
        y = shown.pins["support"]
        pen.line((-13.0, 4.6), (-13.0, y), (13.0, y), (13.0, 4.6), look=shown.line)
        out(pen, shown, "support", 13.0)


def bevels(pen: SymbolPen, shown: Drawn) -> None:
    """The cage of a differential with its four bevel gears."""
    pen.box(-CAGE, -CAGE, CAGE, CAGE, look=MarkStyle(width=1.2, fill="#F3F5F8"))
    for sign in (1.0, -1.0):
        wide, narrow = sign * 9.6, sign * 4.6
        pen.area((-6.4, wide), (6.4, wide), (2.6, narrow), (-2.6, narrow), look=STEEL)
        pen.area((wide, -6.0), (wide, 6.0), (narrow, 2.2), (narrow, -2.2), look=STEEL)
        pen.line((wide, 0.0), (sign * CAGE, 0.0), look=MarkStyle(width=1.6))
    for port, sign in (("left", 1.0), ("right", -1.0)):
        pen.line((0.0, sign * 9.6), (0.0, shown.pins.get(port, 0.0)), look=shown.line)
        out(pen, shown, port, 0.0)
    out(pen, shown, "carrier", CAGE)


def plates(pen: SymbolPen, shown: Drawn) -> None:
    """The same with plates between a side and the cage."""
    bevels(pen, shown)
    if shown.state:
        lining(pen, shown, -8.0, CAGE + 0.6, 8.0, CAGE + 3.4)
    for y in (CAGE, CAGE + 4.0):
        pen.line((-8.0, y), (8.0, y), look=ink(shown, 2.2))


def differential(pen: SymbolPen, shown: Drawn) -> None:
    """With plates where it has a capacity."""
    (plates if _limited(shown.element) else bevels)(pen, shown)


def _limited(element: Any) -> bool:
    given = [getattr(element, name, None) for name in ("preload", "share", "coast_share", "bias", "coast_bias")]
    return any(given) or getattr(element, "locked", False) is True


def ratio_actuator(pen: SymbolPen, _: Drawn) -> None:
    """Two pulleys with a belt, and the arrow of what is set."""
    pen.box(-11.0, -8.0, 11.0, 8.0, look=SLOT)
    for x, radius in ((-5.0, 2.4), (4.0, 4.4)):
        pen.circle(x, 0.0, radius, look=SIGNAL_BODY)
    for sign in (1.0, -1.0):
        pen.line((-5.0, sign * 2.4), (4.0, sign * 4.4), look=SIGNAL_BODY)
    pen.line((-9.0, -6.5), (8.0, 5.8), look=SIGNAL_BODY._replace(width=0.7))
    pen.arrow((9.0, 6.5), (0.81, 0.59), 3.4, look=SIGNAL_BODY)


RACK = {"shaft": 6.0, "mass": -10.0, "support": 20.0}
WORM = {"worm": 8.0, "wheel": -6.0, "support": -20.0}

MESHES = {
    "mesh": Symbol(with_losses(pair, 9.5, 3.0), 16.0, 33.0, 33.0, PAIR),
    "lossy_gear": Symbol(with_losses(pair, 9.5, 3.0), 16.0, 33.0, 33.0, PAIR),
    "lossy_planetary": Symbol(with_losses(planetary, 10.0, 8.5), 20.0, 22.0, 22.0, SETS),
    "rack_pinion": Symbol(rack, 19.0, 21.0, 13.0, RACK),
    "rack_mesh": Symbol(with_losses(rack, 14.0, -3.5), 19.0, 21.0, 13.0, RACK),
    "worm_gear": Symbol(worm, 17.0, 18.0, 21.0, WORM),
    "leadscrew": Symbol(leadscrew, 22.0, 16.0, 15.0, {"screw": 0.0, "mass": -14.0, "support": 15.0}),
    "open_differential": Symbol(bevels, 18.0, 19.0, 19.0, DIFFERENTIAL),
    "limited_slip": Symbol(plates, 18.0, 19.0, 19.0, DIFFERENTIAL),
    "differential": Symbol(differential, 18.0, 19.0, 19.0, DIFFERENTIAL),
    "ratio_actuator": Symbol(ratio_actuator, 12.0, 9.0, 9.0),
}
