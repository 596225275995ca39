"""Torque limiter."""

from __future__ import annotations

from clutchwork.declare import Law, Node, Role, component, law, option, param, port
from clutchwork.elements.bases.contacts import Contact
from clutchwork.laws.coulomb import Coulomb


@component(Role.CONTACT)
class TorqueLimiter(Contact):
    """Clutch under a constant spring force that slips when its torque is exceeded.

    Use it to protect a drive from overload. With the default friction it slips at its break-away torque;
    `Coulomb(static=1.0, kinetic=0.8)` makes it slip at less.
    """

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side whose motion is positive: slip = follower - base")
    torque: float = param("N m", "torque at which it slips, per coefficient", above=0.0, units=("N",))
    friction: Law = law("torque over `torque`, one by default", default=Coulomb(static=1.0, kinetic=1.0))
    locked: bool = option("1", "locked at the start, by an impulse if necessary", default=True, flag=True, last=1)
