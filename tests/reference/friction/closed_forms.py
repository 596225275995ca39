"""Laws that stick, with numbers, and the time in which each of them stops a mass."""

from __future__ import annotations

from collections.abc import Callable
from math import atan, exp, log, sqrt

from scipy.integrate import quad

import clutchwork as cw

STATIC, KINETIC, SPEED, VISCOUS, BAND = 1.0, 0.7, 0.5, 0.2, 0.02
CURVE: dict[str, float] = {"static": STATIC, "kinetic": KINETIC, "speed": SPEED}
FALL = STATIC - KINETIC
POINTS = ((0.0, 0.9), (1.0, 0.7), (10.0, 0.5))

LAWS: dict[str, cw.Law] = {
    "coulomb": cw.Coulomb(static=STATIC, kinetic=KINETIC),
    "exponential": cw.Exponential(static=1.2, slow=STATIC, fast=KINETIC, speed=SPEED),
    "coefficient_table": cw.CoefficientTable(static=STATIC, kinetic=POINTS),
    "stribeck": cw.Stribeck(**CURVE),
    "stribeck tustin": cw.Stribeck(**CURVE, shape="tustin"),
    "stribeck lorentz": cw.Stribeck(**CURVE, shape="lorentz"),
    "stribeck power": cw.Stribeck(**CURVE, shape="power", exponent=0.8),
    "stribeck viscous": cw.Stribeck(static=KINETIC, kinetic=KINETIC, speed=SPEED, viscous=VISCOUS),
    "formula": cw.Formula("kinetic + (static - kinetic)*exp(-v/speed)", **CURVE),
    "karnopp": cw.Karnopp(**CURVE, shape="tustin", band=BAND),
}


def tustin(v: float) -> float:
    """Integral of 1/(kinetic + fall exp(-v/speed)) from 0 to v."""
    return SPEED / KINETIC * log((KINETIC * exp(v / SPEED) + FALL) / (KINETIC + FALL))


def lorentz(v: float) -> float:
    """Integral of 1/(kinetic + fall/(1 + (v/speed)^2)) from 0 to v."""
    x, root = v / SPEED, sqrt(KINETIC / STATIC)
    return SPEED / KINETIC * (x - FALL / STATIC / root * atan(root * x))


def table(v: float) -> float:
    """Integral of 1/coefficient over the two linear pieces that v goes through."""
    first, second = (0.7 - 0.9) / 1.0, (0.5 - 0.7) / 9.0
    return log(0.7 / 0.9) / first + log((0.7 + second * (v - 1.0)) / 0.7) / second


def by_quadrature(exponent: float) -> Callable[[float], float]:
    """Integral of 1/coefficient for a curve without closed form."""
    return lambda v: float(
        quad(lambda x: 1 / (KINETIC + FALL * exp(-((x / SPEED) ** exponent))), 0, v, epsabs=1e-13)[0]
    )


# integral of 1/coefficient from 0 to v [m/s]: mass/load times it is the time to stop
TO_REST: dict[str, Callable[[float], float]] = {
    "coulomb": lambda v: v / KINETIC,
    "exponential": tustin,
    "coefficient_table": table,
    "stribeck": by_quadrature(2.0),
    "stribeck tustin": tustin,
    "stribeck lorentz": lorentz,
    "stribeck power": by_quadrature(0.8),
    "stribeck viscous": lambda v: log(1 + VISCOUS * v / KINETIC) / VISCOUS,
    "formula": tustin,
    "karnopp": lambda v: tustin(v) - tustin(BAND),
}
