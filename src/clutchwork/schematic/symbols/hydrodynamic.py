"""Symbols of couplings and converters with oil, and of the tyre."""

from __future__ import annotations

from clutchwork.schematic.look import INK
from clutchwork.schematic.pen import SymbolPen
from clutchwork.schematic.symbols.gears import out, wheel
from clutchwork.schematic.symbols.symbol import LEFT, RIGHT, Drawn, Symbol, ends

SHELL = INK._replace(width=1.2)
SUPPORT = -16.0


def _shells(pen: SymbolPen, gap: float, low: float = 2.5) -> None:
    """Two half shells that face each other, above the shaft and below."""
    for side in (LEFT, RIGHT):
        for sign in (1.0, -1.0):
            pen.line((side * gap, sign * 11.0), (side * gap, sign * low), look=SHELL)
            pen.line((side * gap, sign * 11.0), (side * 6.5, sign * 10.0), (side * 8.0, sign * 6.7), look=INK)
            pen.line((side * 8.0, sign * 6.7), (side * 6.5, sign * 3.5), (side * gap, sign * low), look=INK)
        pen.line((side * 8.0, 6.7), (side * 8.0, -6.7), look=SHELL)


def fluid_coupling(pen: SymbolPen, shown: Drawn) -> None:
    """Two half shells."""
    _shells(pen, 1.6)
    ends(pen, shown, -8.0, 8.0)


def torque_converter(pen: SymbolPen, shown: Drawn) -> None:
    """The same with a stator between them, at the support."""
    _shells(pen, 2.4, 3.5)
    for sign in (1.0, -1.0):
        pen.line((0.0, sign * 3.0), (0.0, sign * 7.0), look=INK._replace(width=1.8))
    pen.line((0.0, -3.0), (0.0, SUPPORT), look=SHELL)
    out(pen, shown, "impeller", 8.0)
    out(pen, shown, "turbine", 8.0)
    out(pen, shown, "support", 0.0)


HYDRODYNAMIC = {
    "fluid_coupling": Symbol(fluid_coupling),
    "torque_converter": Symbol(torque_converter, 18.0, 12.0, 22.0, {"support": SUPPORT}),
    "tyre": Symbol(wheel, 18.0, 16.0, 17.0, {"support": 16.0}),
}
