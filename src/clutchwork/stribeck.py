"""The Stribeck curve that many friction laws share."""

from __future__ import annotations

from clutchwork.node import Law
from clutchwork.schema import choice, family, param

SHAPES = ("gaussian", "tustin", "lorentz", "power")


@family
class StribeckCurve(Law):
    """Coefficient `s(v) = kinetic + (static - kinetic) shape(v)` over abs(slip), and a viscous part beside it."""

    static: float = param("1", "coefficient at rest, at least the kinetic one", above=0.0)
    kinetic: float = param("1", "coefficient at high slip", at_least=0.0)
    speed: float = param("rad/s", "slip over which it falls, the Stribeck speed", above=0.0, units=("m/s",))
    shape: str = choice(
        "of the fall, x = abs(slip)/speed: exp(-x^2), exp(-x), 1/(1 + x^2) or exp(-x^exponent)",
        choices=SHAPES,
        default="gaussian",
    )
    exponent: float = param("1", 'exponent, only with shape "power"', default=2.0, above=0.0)
    viscous: float = param(
        "s/rad", "viscous part, the coefficient that it adds per slip", default=0.0, at_least=0.0, units=("s/m",)
    )
