"""Symbols of oil: volumes, openings, valves, accumulators and pumps, after ISO 1219."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from clutchwork.schematic.look import BLANK, INK, OIL, SIGNAL_BODY, MarkStyle
from clutchwork.schematic.pen import SymbolPen
from clutchwork.schematic.symbols.gears import out, wheel
from clutchwork.schematic.symbols.symbol import LEFT, RIGHT, Drawn, Symbol, ends
from clutchwork.schematic.symbols.torques import to_shaft

SLOT = BLANK._replace(colour=SIGNAL_BODY.colour, width=SIGNAL_BODY.width)
FULL = SIGNAL_BODY._replace(fill="#E6DDF0", width=0.7)
THIN = SIGNAL_BODY._replace(width=0.8)
# where the oil of a pump goes in and comes out
PUMP = {"inlet": -10.5, "outlet": 10.5}
SHELL = INK._replace(width=1.2)
SUPPORT = -16.0


def pipes(pen: SymbolPen, shown: Drawn, edge: float, sump: tuple[float, float] = (0.0, -7.0)) -> None:
    """Lines of oil from an edge to its ports; below, where one is at the sump, a tank."""
    for port, side in shown.sides.items():
        y = shown.pins.get(port, 0.0)
        pen.line((side * edge, y), (side * shown.half, y), look=OIL)
    if shown.fixed - {"base"}:
        tank(pen, *sump)


def tank(pen: SymbolPen, x: float, y: float) -> None:
    """A line that ends in an open vessel."""
    pen.line((x, y), (x, y - 6.0), look=OIL)
    pen.line((x - 5.0, y - 3.0), (x - 5.0, y - 7.5), (x + 5.0, y - 7.5), (x + 5.0, y - 3.0), look=OIL)


def _drop(pen: SymbolPen, x: float, y: float, size: float, look: MarkStyle) -> None:
    sides = ((x + size, y - 0.3 * size), (x, y - 1.2 * size), (x - size, y - 0.3 * size))
    pen.area((x, y + 1.6 * size), *sides, look=look)


def oil(pen: SymbolPen, _: Drawn) -> None:
    """A drop beside a thermometer."""
    pen.box(-11.0, -8.0, 11.0, 8.0, look=SLOT)
    _drop(pen, -4.0, -0.5, 3.6, FULL)
    pen.line((5.0, -2.0), (5.0, 5.5), look=THIN)
    pen.circle(5.0, -4.0, 2.0, look=FULL)


def volume(pen: SymbolPen, _: Drawn) -> None:
    """A line full of oil."""
    pen.box(-11.0, -6.0, 11.0, 6.0, look=SLOT)
    pen.box(-9.5, -4.5, 9.5, 4.5, look=FULL)


def orifice(pen: SymbolPen, shown: Drawn) -> None:
    """A line with a narrow place."""
    pen.line((-12.0, 0.0), (12.0, 0.0), look=SIGNAL_BODY)
    for sign in (1.0, -1.0):
        bend = ((-5.0, sign * 6.0), (-2.2, sign * 2.6), (2.2, sign * 2.6), (5.0, sign * 6.0))
        pen.line(*bend, look=SIGNAL_BODY)
    pipes(pen, shown, 12.0, (next((-12.0 * side for side in shown.sides.values()), 12.0), 0.7))


def relief(pen: SymbolPen, shown: Drawn) -> None:
    """A box with an arrow beside its line, and a spring."""
    pen.box(-7.0, -7.0, 7.0, 7.0, look=SLOT)
    pen.line((-3.0, -7.0), (-3.0, 4.0), look=THIN)
    pen.arrow((-3.0, 6.0), (0.0, 1.0), 3.4, look=SIGNAL_BODY)
    spring = ((0.0, 7.0), (2.6, 8.0), (-2.6, 9.5), (2.6, 11.0), (0.0, 12.0))
    pen.line(*spring, look=THIN)
    pipes(pen, shown, 7.0)


def spool(pen: SymbolPen, shown: Drawn) -> None:
    """Two boxes: supply to clutch, clutch to exhaust."""
    pen.box(-12.0, -6.5, 0.0, 6.5, look=SLOT)
    pen.box(0.0, -6.5, 12.0, 6.5, look=SLOT)
    pen.line((-8.0, -6.5), (-5.0, 3.6), look=THIN)
    pen.arrow((-4.2, 6.0), (0.3, 0.95), 3.4, look=SIGNAL_BODY)
    pen.line((8.0, 6.5), (5.0, -3.6), look=THIN)
    pen.arrow((4.2, -6.0), (-0.3, -0.95), 3.4, look=SIGNAL_BODY)
    pipes(pen, shown, 12.0, (4.2, -6.5))


def accumulator(pen: SymbolPen, shown: Drawn) -> None:
    """A vessel with gas above its oil, or with a spring."""
    pen.box(-6.0, -9.0, 6.0, 9.0, look=SLOT)
    pen.box(-5.0, -8.0, 5.0, -0.6, look=FULL)
    pen.line((-6.0, 0.0), (6.0, 0.0), look=SIGNAL_BODY)
    if getattr(shown.element, "against", "gas") == "spring":
        pen.line((0.0, 0.0), (-3.0, 2.0), (3.0, 4.0), (-3.0, 6.0), (0.0, 9.0), look=THIN)
    else:
        pen.area((-2.2, 6.0), (2.2, 6.0), (0.0, 2.4), look=SLOT)


def pump(pen: SymbolPen, shown: Drawn) -> None:
    """A circle with a triangle that points outwards."""
    pen.circle(0.0, 0.0, 10.5, look=BLANK)
    pen.area((-3.6, 4.4), (3.6, 4.4), (0.0, 10.2), look=INK._replace(fill=INK.colour))
    shafts = {port: side for port, side in shown.sides.items() if port not in PUMP}
    to_shaft(pen, replace(shown, sides=shafts), 10.5)
    for port, end in PUMP.items():
        if port in shown.sides:
            pen.line((0.0, end), (0.0, 1.3 * end), (shown.sides[port] * shown.half, 1.3 * end), look=OIL)
    if shown.fixed - {"base"}:
        tank(pen, 0.0, -10.5)


def oil_of_pump(pen: SymbolPen, shown: Drawn) -> None:
    """The same without a shaft."""
    pen.circle(0.0, 0.0, 8.5, look=SLOT)
    pen.area((-3.0, 3.4), (3.0, 3.4), (0.0, 8.2), look=SIGNAL_BODY._replace(fill=SIGNAL_BODY.colour))
    pipes(pen, shown, 8.5, (0.0, -8.5))


def valve_body(pen: SymbolPen, shown: Drawn) -> None:
    """A pump in a casing with valves."""
    pen.box(-12.0, -11.0, 12.0, 11.0, look=BLANK)
    pen.circle(0.0, -3.4, 5.0, look=INK)
    pen.area((-1.8, -1.2), (1.8, -1.2), (0.0, 1.4), look=INK._replace(fill=INK.colour))
    for x in (-10.0, -3.0, 4.0):
        pen.box(x, 4.2, x + 3.0, 8.4, look=MarkStyle(width=0.8))
        pen.box(x + 3.0, 4.2, x + 6.0, 8.4, look=MarkStyle(width=0.8))
    to_shaft(pen, shown, 12.0)


def _ports_of_spool(element: Any) -> Mapping[str, float]:
    """Apart where three lines come to a spool."""
    third = getattr(type(getattr(element, "exhaust", None)), "gathers", False)
    return {"supply": 4.0, "exhaust": -4.0} if third else {}


HYDRAULIC = {
    "hydraulic_oil": Symbol(oil, 12.0, 9.0, 9.0),
    "oil_volume": Symbol(volume, 11.0, 7.0, 7.0),
    "orifice": Symbol(orifice, 14.0, 7.0, 7.0),
    "relief_valve": Symbol(relief, 13.0, 12.0, 8.0),
    "spool_valve": Symbol(spool, 15.0, 8.0, 8.0, _ports_of_spool),
    "accumulator": Symbol(accumulator, 6.0, 10.0, 10.0),
    "pump_flow": Symbol(oil_of_pump, 12.0, 9.5, 9.5),
    "pump": Symbol(pump, 15.0, 14.0, 14.0, {port: 1.3 * end for port, end in PUMP.items()}),
    "pump_torque": Symbol(pump, 15.0, 11.0, 11.0),
    "valve_body": Symbol(valve_body, 16.0, 12.0, 12.0),
}


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
