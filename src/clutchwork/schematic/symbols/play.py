"""Symbols of backlash, gaps and stops."""

from __future__ import annotations

from clutchwork.schematic.look import INK, THIN
from clutchwork.schematic.pen import SymbolPen
from clutchwork.schematic.symbols.symbol import Drawn, Symbol, ends
from clutchwork.schematic.symbols.torques import zigzag

FLANK = INK._replace(width=1.8)


def fork(pen: SymbolPen, left: float, right: float) -> None:
    """A tooth in a gap that is wider than it."""
    middle = 0.5 * (left + right)
    pen.line((left, 0.0), (left + 2.5, 0.0))
    pen.line((middle + 2.5, 8.0), (left + 2.5, 8.0), (left + 2.5, -8.0), (middle + 2.5, -8.0), look=FLANK)
    pen.line((middle + 2.5, 8.0), (middle + 2.5, 5.0), look=FLANK)
    pen.line((middle + 2.5, -8.0), (middle + 2.5, -5.0), look=FLANK)
    pen.line((middle - 1.2, 5.0), (middle - 1.2, -5.0), look=FLANK)
    pen.line((middle - 1.2, 0.0), (right, 0.0))


def backlash(pen: SymbolPen, shown: Drawn) -> None:
    """A tooth in its gap."""
    fork(pen, -12.0, 12.0)
    ends(pen, shown, -12.0, 12.0)


def elastic_backlash(pen: SymbolPen, shown: Drawn) -> None:
    """A tooth in its gap, on a spring."""
    zigzag(pen, -16.0, -1.0, 0.0, 5.0)
    fork(pen, -1.0, 16.0)
    ends(pen, shown, -16.0, 16.0)


def elastic_gap(pen: SymbolPen, shown: Drawn) -> None:
    """A spring with a plate at its end, and one before it."""
    zigzag(pen, -15.0, 3.0, 0.0, 5.0)
    for x in (3.0, 8.0):
        pen.line((x, -8.0), (x, 8.0), look=FLANK)
    pen.line((8.0, 0.0), (13.0, 0.0))
    ends(pen, shown, -15.0, 13.0)


def end_stop(pen: SymbolPen, shown: Drawn) -> None:
    """A block between two stops."""
    for sign in (-1.0, 1.0):
        pen.line((sign * 11.0, -9.0), (sign * 11.0, 4.0), look=FLANK)
    pen.line((-14.0, -9.0), (11.0, -9.0), look=FLANK)
    pen.line((-14.0, -9.0), (-14.0, 0.0))
    pen.box(-4.0, -4.0, 4.0, 4.0, look=FLANK)
    pen.line((4.0, 0.0), (6.5, 0.0), (6.5, 8.0), (14.0, 8.0), (14.0, 0.0))
    ends(pen, shown, -14.0, 14.0)


def displacement(pen: SymbolPen, shown: Drawn) -> None:
    """A measure between two lines."""
    for x in (-12.0, 12.0):
        pen.line((x, -7.0), (x, 7.0))
    pen.line((-9.0, 0.0), (9.0, 0.0), look=THIN)
    for sign in (-1.0, 1.0):
        pen.line((sign * 7.0, 2.5), (sign * 10.0, 0.0), (sign * 7.0, -2.5), look=THIN)
    ends(pen, shown, -12.0, 12.0)


PLAY = {
    "displacement": Symbol(displacement),
    "backlash": Symbol(backlash),
    "elastic_backlash": Symbol(elastic_backlash),
    "elastic_gap": Symbol(elastic_gap),
    "end_stop": Symbol(end_stop),
}
