"""Tyre."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from clutchwork.declare import (
    Node,
    Role,
    SignalLike,
    State,
    StateSum,
    Way,
    component,
    exact,
    option,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.heating import Heating

WAYS = (
    Way("slip", "speed of the mass over that of the tread", domain="translation"),
    Way("speed", "speed of the mass over the road", watched=True, domain="translation"),
)


@component(
    Role.TORQUE,
    states=(State("deflection", "m", "deflection of the tread along the road, that of the slip at rest"),),
    hooks=("margin", "cross", "turns", "settle"),
    ways=WAYS,
)
class Tyre(Heating):
    """Tyre by the Magic Formula with relaxation; it holds a vehicle at rest like a spring.

    Use it where wheels slip, and for the elasticity between driveline and road. The force on the mass is `load D sin(C
    atan(B x - E (B x - atan(B x))))`; x is the slip ratio, reached over the relaxation length, and at rest a deflection
    of the tread. `torque` is that force [N], `rate` the speed of the mass over that of the tread, `slip` the ratio x,
    positive where the tread is faster forward than the road.
    """

    shaft: Node = port("wheel", domain="rotation")
    mass: Node = port("vehicle, or its share on this wheel", domain="translation")
    support: Node | None = port("member that carries the wheel and takes the reaction", default=None, domain="rotation")
    radius: float = option("m", "rolling radius", above=0.0)
    load: SignalLike = signal("N", "vertical load; none at zero and below", presses=True, example=4000.0)
    B: float = param("1", "stiffness factor", default=10.0, above=0.0)
    C: float = param("1", "shape factor; above 2 a wheel that spins would brake", default=1.65, above=0.0, at_most=2.0)
    D: float = param("1", "peak factor, the largest force over the load", default=1.0, above=0.0)
    E: float = param("1", "curvature factor", default=0.3, at_most=1.0)
    relaxation_length: float = param("m", "distance over which the force builds up", default=0.25, above=0.0)
    slip_limit: float = param(
        "1", "slip ratio at which a wheel that spins at standstill saturates", default=2.0, above=0.0
    )
    low_speed: float = param("m/s", "speed up to which the damping acts", default=2.5, above=0.0)
    low_speed_damping: float = param(
        "N s/m", "damping of the standing tyre, which fades up to the low speed", at_least=0.0, example=1000.0
    )
    initial_deflection: float = option("m", "deflection at the start", default=0.0)

    def directions(self) -> Mapping[str, Mapping[str, float | Fraction]]:
        """Slip of the contact, and the speed of the mass."""
        radius = exact(self.radius)
        return {"slip": {"mass": 1, "shaft": -radius, "support": radius}, "speed": {"mass": 1}}

    def state_sums(self) -> tuple[StateSum, ...]:
        """The slip ratio that its force follows."""
        return (StateSum("slip", "1", {"deflection": 1.0 / self.relaxation_length}),)

    def initial_states(self) -> tuple[float, ...]:
        """Deflection at the start [m]."""
        return (self.initial_deflection,)
