"""Grip of a belt on its pulley."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Node, Role, SignalLike, component, param, port, signal
from clutchwork.elements.bases.contacts import Sticking
from clutchwork.laws.coulomb import Coulomb


@component(Role.CONTACT, hooks=("gain",))
class BeltContact(Sticking):
    """Contact whose load is a tension minus the centrifugal force of a belt, times a factor for each direction of slip.

    It holds and slips with `forward` or `backward` times (tension - mass_per_length speed^2), and with nothing where
    that is not above zero. `BeltDrive` has one, with the factors of Eytelwein; use it alone for ropes around drums and
    for belts with other limits. The speed may be that of a shaft or a mass.

    Equations: docs/theory/belts.md.
    """

    friction = Coulomb(static=1.0, kinetic=1.0)
    lifts: ClassVar[tuple[str, str] | None] = (
        "the centrifugal force of the belt takes all of its tension",
        "give it more tension or less mass, or turn it slower",
    )

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side whose motion is positive: slip = follower - base")
    forward: float = param("1", "force against forward slip over what is left of the tension", above=0.0, example=1.6)
    backward: float = param("1", "force against backward slip over the same", above=0.0, example=1.6)
    mass_per_length: float = param("kg/m", "mass of the belt over its length", default=0.0, at_least=0.0)
    tension: SignalLike = signal("N", "tension of a strand", presses=True, example=500.0)
    speed: SignalLike = signal("m/s", "speed of the belt", default=0.0)
