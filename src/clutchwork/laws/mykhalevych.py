"""Mykhalevych's friction: a wind-up angle that is limited."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.node import Law
from clutchwork.schema import Role, State, choice, component, flag, param


@component(Role.LAW, states=(State("wind_up", "1", "wind-up over the elastic angle"),))
class Mykhalevych(Law):
    """Elastic wind-up under a hyperbolic tangent, and a Stribeck fall beside it.

    Coefficient `static tanh(q) - sign(slip) (static - kinetic) (1 - exp(-(slip/speed)^2))` with
    `q = wind_up + viscous slip/speed`; the wind-up follows the slip within a range. Use it for elastic pre-sliding
    without drift with few parameters. It needs enough `viscous` to be dissipative; `passive` always is, its coefficient
    is `(kinetic + (static - kinetic) exp(-(slip/speed)^2)) tanh(q)`.

    Equations: docs/theory/friction-laws.md.
    """

    sticks: ClassVar[bool] = False

    static: float = param("1", "coefficient at rest, at least the kinetic one", above=0.0)
    kinetic: float = param("1", "coefficient at high slip", at_least=0.0)
    elastic: float = param("rad", "wind-up over which the contact is elastic", above=0.0, units=("m",))
    speed: float = param("rad/s", "slip that divides static from kinetic", above=0.0, units=("m/s",))
    viscous: float = param("1", "inner friction, against the slip over `speed`", at_least=0.0)
    reset: str = choice(
        "how the wind-up is limited: within plus and minus `range`; clipped to 1 when the slip passes through zero; set"
        " to 1 whenever it does, as printed, which ratchets",
        choices=("saturate", "clip", "literal"),
        default="saturate",
    )
    range: float = param("1", 'largest wind-up over `elastic`, of reset "saturate"', default=3.0, above=0.0)
    passive: bool = flag("multiply tanh by the Stribeck curve instead, which never feeds energy in", default=False)
