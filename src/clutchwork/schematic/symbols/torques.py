"""Symbols of springs, dampers, sources and loads."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from math import pi, tanh
from typing import Any

from clutchwork.schematic.look import BLANK, BODY, GREY, INK, THIN, MarkStyle
from clutchwork.schematic.pen import Point, SymbolPen
from clutchwork.schematic.symbols.symbol import LEFT, RIGHT, Drawn, Symbol, ends, wall


def zigzag(pen: SymbolPen, left: float, right: float, y: float, tall: float = 4.0) -> None:
    """A spring."""
    start, stop, count = left + 2.5, right - 2.5, 6
    step = (stop - start) / count
    peaks = [(start + (k + 0.5) * step, y + (tall if k % 2 == 0 else -tall)) for k in range(count)]
    pen.line((left, y), (start, y), *peaks, (stop, y), (right, y), look=INK._replace(width=1.2))


def dashpot(pen: SymbolPen, left: float, right: float, y: float, tall: float = 4.0) -> None:
    """A damper."""
    middle = 0.5 * (left + right)
    pen.line((middle + 4.0, y - tall), (middle - 4.5, y - tall), (middle - 4.5, y + tall), (middle + 4.0, y + tall))
    pen.line((left, y), (middle - 4.5, y))
    pen.line((middle + 1.0, y - tall + 1.4), (middle + 1.0, y + tall - 1.4), look=INK._replace(width=1.8))
    pen.line((middle + 1.0, y), (right, y))


def spring(pen: SymbolPen, shown: Drawn) -> None:
    """A spring between two shafts."""
    zigzag(pen, -14.0, 14.0, 0.0, 6.0)
    ends(pen, shown, -14.0, 14.0)


def damper(pen: SymbolPen, shown: Drawn) -> None:
    """A damper between two shafts."""
    dashpot(pen, -12.0, 12.0, 0.0, 6.0)
    ends(pen, shown, -12.0, 12.0)


def spring_damper(pen: SymbolPen, shown: Drawn) -> None:
    """Both in parallel."""
    for x in (-14.0, 14.0):
        pen.line((x, -7.0), (x, 7.0), look=INK._replace(width=1.2))
    zigzag(pen, -14.0, 14.0, 7.0)
    dashpot(pen, -14.0, 14.0, -7.0)
    ends(pen, shown, -14.0, 14.0)


def flexible_shaft(pen: SymbolPen, shown: Drawn) -> None:
    """Inertias with springs between them."""
    for x in (-16.0, 0.0, 16.0):
        pen.box(x - 1.6, -7.0, x + 1.6, 7.0, look=BODY._replace(width=1.0))
    zigzag(pen, -14.4, -1.6, 0.0, 3.6)
    zigzag(pen, 1.6, 14.4, 0.0, 3.6)
    ends(pen, shown, -17.6, 17.6)


def nonlinear_spring(pen: SymbolPen, shown: Drawn) -> None:
    """A spring with a bent line across it."""
    zigzag(pen, -14.0, 14.0, 0.0, 6.0)
    pen.line((-11.0, -9.0), (-4.0, -2.5), (4.0, 2.5), (11.0, 9.0), look=THIN)
    ends(pen, shown, -14.0, 14.0)


def jenkins_element(pen: SymbolPen, shown: Drawn) -> None:
    """A spring in series with two plates that rub."""
    zigzag(pen, -14.0, 3.0, 0.0, 6.0)
    pen.line((3.0, 0.0), (9.0, 0.0), look=INK._replace(width=2.0))
    for y in (-3.0, 3.0):
        pen.line((4.0, y), (13.0, y), look=INK._replace(width=1.6))
    pen.line((13.0, -3.0), (13.0, 3.0))
    ends(pen, shown, -14.0, 13.0)


def torsional_damper(pen: SymbolPen, shown: Drawn) -> None:
    """A spring with a bent line across it, and a spring in series with plates that rub, in parallel."""
    for x in (-14.0, 14.0):
        pen.line((x, -7.0), (x, 7.0), look=INK._replace(width=1.2))
    zigzag(pen, -14.0, 14.0, 7.0)
    pen.line((-10.0, 1.5), (-3.0, 5.5), (3.0, 8.5), (10.0, 12.5), look=THIN)
    zigzag(pen, -14.0, 3.0, -7.0, 3.0)
    pen.line((3.0, -7.0), (9.0, -7.0), look=INK._replace(width=2.0))
    for y in (-9.5, -4.5):
        pen.line((4.0, y), (14.0, y), look=INK._replace(width=1.4))
    ends(pen, shown, -14.0, 14.0)


def wet_drag(pen: SymbolPen, shown: Drawn) -> None:
    """Two plates with oil between them."""
    for x in (-7.0, 7.0):
        pen.line((x, -11.0), (x, 11.0), look=INK._replace(width=2.0))
    for y in (-7.0, 0.0, 7.0):
        pen.line((-4.6, y), (-2.3, y + 1.8), (0.0, y), (2.3, y - 1.8), (4.6, y), look=THIN._replace(colour="#0072B2"))
    ends(pen, shown, -7.0, 7.0)


def to_shaft(pen: SymbolPen, shown: Drawn, radius: float) -> None:
    """Lines from a symbol to its shaft."""
    for side in (LEFT, RIGHT):
        if side in shown.sides.values():
            pen.line((side * radius, 0.0), (side * shown.half, 0.0), look=shown.line)
    if not shown.sides:
        wall(pen, LEFT, -radius, shown)


def torque(pen: SymbolPen, shown: Drawn) -> None:
    """A circle with an arrow: around a shaft, along a line."""
    pen.circle(0.0, 0.0, 10.5, look=BLANK)
    if shown.line.colour != INK.colour:
        pen.line((6.0, 0.0), (-3.0, 0.0), look=INK._replace(width=1.4))
        pen.arrow((-7.0, 0.0), (-1.0, 0.0), 4.5)
    else:
        pen.arc(0.0, 0.0, 6.0, -0.35 * pi, 1.2 * pi, look=INK._replace(width=1.2))
        pen.arrow((-5.3, -5.6), (0.35, -0.93), 4.2)
    to_shaft(pen, shown, 10.5)


def prescribed(turning: str, moving: str) -> Callable[[SymbolPen, Drawn], None]:
    """Two circles with the letter of the motion, of a shaft or of a mass."""

    def draw(pen: SymbolPen, shown: Drawn) -> None:
        pen.circle(0.0, 0.0, 10.5, look=BLANK)
        pen.circle(0.0, 0.0, 8.6, look=MarkStyle(width=0.6))
        pen.text(0.0, -2.8, turning if shown.line.colour == INK.colour else moving, 9.5)
        to_shaft(pen, shown, 10.5)

    return draw


def motor(pen: SymbolPen, shown: Drawn) -> None:
    """A circle with the letter of a machine."""
    pen.circle(0.0, 0.0, 10.5, look=BLANK)
    pen.text(0.0, -3.2, "M", 10.0)
    to_shaft(pen, shown, 10.5)


def engine(pen: SymbolPen, shown: Drawn) -> None:
    """A cylinder with its piston and a crank."""
    pen.box(-11.0, -10.5, 11.0, 10.5, look=BLANK)
    pen.line((-4.5, 8.5), (-4.5, -0.5), look=INK._replace(width=1.2))
    pen.line((4.5, 8.5), (4.5, -0.5), look=INK._replace(width=1.2))
    pen.box(-3.6, 1.5, 3.6, 5.5, look=BODY)
    pen.line((0.0, 3.0), (2.4, -5.2), look=INK._replace(width=1.4))
    pen.circle(0.0, -5.6, 3.2, look=MarkStyle(width=0.8))
    to_shaft(pen, shown, 11.0)


def over_speed(points: Callable[[Any], list[Point]]) -> Callable[[SymbolPen, Drawn], None]:
    """A box with the course of a torque over the speed."""

    def draw(pen: SymbolPen, shown: Drawn) -> None:
        pen.box(-11.0, -10.0, 11.0, 10.0, look=BLANK)
        found = points(shown.element)
        least, most = min(y for _, y in found), max(y for _, y in found)
        zero = -7.0 if least >= 0.0 else 7.0 if most <= 0.0 else 0.0
        tall = 14.0 if zero else 7.0
        first = -8.0 if min(x for x, _ in found) >= 0.0 else 0.0
        pen.line((-8.5, zero), (8.5, zero), look=THIN._replace(colour=GREY))
        pen.line((pen.sign * first, -8.0), (pen.sign * first, 8.0), look=THIN._replace(colour=GREY))
        size = max(abs(least), abs(most)) or 1.0
        wide = max(abs(x) for x, _ in found) or 1.0
        span = 16.0 if first else 8.0
        # the course stands upright also in a mirrored box
        line = [(pen.sign * (first + span * x / wide), zero + tall * y / size) for x, y in found]
        pen.line(*line, look=INK._replace(width=1.5))
        to_shaft(pen, shown, 11.0)

    return draw


def _table(element: Any) -> list[Point]:
    with suppress(Exception):
        found = [(float(x), float(y)) for x, y in element.torque]
        if len(found) > 1:
            return found
    return [(0.0, 0.6), (0.4, 1.0), (1.0, 0.5)]


def _sign(element: Any) -> float:
    with suppress(Exception):
        return -1.0 if float(element.nominal_torque) < 0.0 else 1.0
    return 1.0


def _linear(element: Any) -> list[Point]:
    sign, one = _sign(element), bool(getattr(element, "same_direction", False))
    return [(-1.0, sign if one else -sign), (0.0, 0.0), (1.0, sign)]


def _quadratic(element: Any) -> list[Point]:
    sign, one = _sign(element), bool(getattr(element, "same_direction", False))
    steps = [0.1 * k for k in range(-10, 11)]
    return [(x, sign * (x * x if one else x * abs(x))) for x in steps]


def _resisting(_: Any) -> list[Point]:
    return [(0.1 * k, -tanh(0.6 * k)) for k in range(-10, 11)]


def _eddy(_: Any) -> list[Point]:
    return [(0.5 * k, -k / (1.0 + 0.25 * k * k)) for k in range(11)]


def _retarder(element: Any) -> list[Point]:
    with suppress(Exception):
        k, most, power = (float(getattr(element, name)) for name in ("capacity", "max_torque", "max_power"))
        last = 1.6 * max(
            min((most / k) ** 0.5, (power / k) ** (1 / 3)), power / most if k * (power / most) ** 2 > most else 0.0
        )
        speeds = [last * step / 40 for step in range(1, 41)]
        return [(0.0, 0.0), *((w, -min(k * w * w, most, power / w)) for w in speeds)]
    return [(0.0, 0.0), (0.5, -1.0), (1.0, -1.0)]


def motion_sensor(pen: SymbolPen, shown: Drawn) -> None:
    """A dial with a needle, on thin lines, for it transmits nothing."""
    pen.circle(0.0, 0.0, 10.5, look=BLANK)
    pen.arc(0.0, -3.0, 8.0, 0.15 * pi, 0.85 * pi, look=THIN)
    pen.line((0.0, -3.0), (4.0, 3.4), look=INK._replace(width=1.2))
    for side in (LEFT, RIGHT):
        if side in shown.sides.values():
            pen.line((side * shown.half, 0.0), (side * 10.5, 0.0), look=THIN)
        else:
            wall(pen, side, side * 10.5, shown)


def torque_sensor(pen: SymbolPen, shown: Drawn) -> None:
    """A dial around a shaft that goes through."""
    pen.circle(0.0, 0.0, 10.5, look=BLANK)
    pen.arc(0.0, 1.0, 6.5, 0.15 * pi, 0.85 * pi, look=THIN)
    pen.line((0.0, 2.0), (3.0, 6.6), look=INK._replace(width=1.2))
    pen.line((-10.5, -3.0), (10.5, -3.0), look=shown.line)
    ends(pen, shown, -10.5, 10.5)


def unknown(pen: SymbolPen, shown: Drawn) -> None:
    """An element that has no symbol of its own: a box, its ports one below the other."""
    tall = max(10.0, *(abs(y) + 6.0 for y in shown.pins.values())) if shown.pins else 10.0
    pen.box(-12.0, -tall, 12.0, tall, look=BODY)
    kind = "".join(word[0].upper() for word in str(getattr(shown.element, "kind", "?")).split("_") if word)
    pen.text(0.0, -2.8, kind[:3], 8.0)
    for port, side in shown.sides.items():
        y = shown.pins.get(port, 0.0)
        pen.line((side * 12.0, y), (side * shown.half, y), look=shown.line)


TORQUES = {
    "spring": Symbol(spring, 18.0, 8.0, 8.0),
    "damper": Symbol(damper, 16.0, 8.0, 8.0),
    "spring_damper": Symbol(spring_damper, 18.0),
    "nonlinear_spring": Symbol(nonlinear_spring, 18.0, 10.0, 10.0),
    "jenkins_element": Symbol(jenkins_element, 18.0, 8.0, 8.0),
    "torsional_damper": Symbol(torsional_damper, 18.0),
    "flexible_shaft": Symbol(flexible_shaft, 22.0, 8.0, 8.0),
    "wet_drag": Symbol(wet_drag),
    "torque": Symbol(torque, 15.0, 11.0, 11.0),
    "prescribed_speed": Symbol(prescribed("ω", "v"), 15.0, 11.0, 11.0),
    "prescribed_position": Symbol(prescribed("φ", "x"), 15.0, 11.0, 11.0),
    "prescribed_acceleration": Symbol(prescribed("α", "a"), 15.0, 11.0, 11.0),
    "electric_motor": Symbol(motor, 15.0, 11.0, 11.0),
    "motor_torque": Symbol(motor, 15.0, 11.0, 11.0),
    "engine": Symbol(engine, 15.0, 11.0, 11.0),
    "engine_torque": Symbol(engine, 15.0, 11.0, 11.0),
    "speed_torque": Symbol(over_speed(_table), 15.0, 11.0, 11.0),
    "linear_torque": Symbol(over_speed(_linear), 15.0, 11.0, 11.0),
    "quadratic_torque": Symbol(over_speed(_quadratic), 15.0, 11.0, 11.0),
    "eddy_current_brake": Symbol(over_speed(_eddy), 15.0, 11.0, 11.0),
    "retarder": Symbol(over_speed(_retarder), 15.0, 11.0, 11.0),
    "motion_sensor": Symbol(motion_sensor, 15.0, 11.0, 11.0),
    "torque_sensor": Symbol(torque_sensor, 15.0, 11.0, 11.0),
    "resisting_torque": Symbol(over_speed(_resisting), 15.0, 11.0, 11.0),
}
