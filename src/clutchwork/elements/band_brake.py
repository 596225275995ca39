"""Band brake."""

from __future__ import annotations

from math import tau

from clutchwork.declare import Node, Role, SignalLike, component, flag, param, port, signal
from clutchwork.elements.bases.contacts import Contact


@component(Role.CONTACT, hooks=("gain",))
class BandBrake(Contact):
    """Band around a drum, pulled at one end and fixed at the other: self-energising in one direction.

    The torque is `force radius (exp(coefficient wrap) - 1)` where the drum pulls the band on, forward slip unless
    `reversed`, and `force radius (1 - exp(-coefficient wrap))` where it pulls it off. Use it for the bands of planetary
    gearboxes and for hoists.

    Source: R. G. Budynas, J. K. Nisbett, Shigley's Mechanical Engineering Design, chapter on clutches and brakes.
    """

    shaft: Node = port("drum: slip is its speed relative to the base")
    base: Node | None = port("member that takes the reaction", default=None)
    radius: float = param("m", "radius of the drum", above=0.0)
    wrap: float = param("rad", "angle over which the band lies on the drum", above=0.0, at_most=3 * tau)
    reversed: bool = flag("self-energising in backward slip", default=False)
    force: SignalLike = signal("N", "force at the pulled end; below zero counts as zero", presses=True)
