"""Rolling resistance of a vehicle."""

from __future__ import annotations

from clutchwork.declare import Law, Node, Role, SignalLike, component, law, option, param, port, signal
from clutchwork.elements.bases.contacts import Contact


@component(Role.CONTACT)
class RollingResistance(Contact):
    """Force `weight cos(a) coefficient` against the motion, with `a = atan(slope)`; it holds at rest.

    Use it for tyres on a road; `Vehicle` holds one. A vehicle at rest stays there while all other forces are at most
    `weight cos(a)` times the static coefficient, on a slope below that coefficient for one.
    """

    shaft: Node = port("mass that rolls", domain="translation")
    friction: Law = law("rolling coefficient over the speed, static coefficient at rest")
    weight: float = param("N", "weight of all that rolls with it", above=0.0)
    slope: SignalLike = signal("1", "rise over horizontal distance, positive uphill", default=0.0, example=0.05)
    tolerance: float = option(
        "m/s", "speed below which it may lock; 0: at exactly zero", default=0.0, at_least=0.0, last=1
    )
