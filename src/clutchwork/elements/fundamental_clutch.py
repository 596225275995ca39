"""Clutch whose torques are inputs."""

from __future__ import annotations

from clutchwork.declare import Node, Role, SignalLike, component, option, port, signal
from clutchwork.elements.bases.contacts import Sticking
from clutchwork.laws.coulomb import Coulomb


@component(Role.CONTACT, hooks=("limit",))
class FundamentalClutch(Sticking):
    """Clutch that slips with a given torque and holds between two given limits.

    Use it where friction is computed elsewhere. It locks when the slip is within the tolerance and the torque that it
    takes lies between `lower` and `upper`; it releases when the torque leaves them. Torques are those on the follower:
    the lower limit resists forward slip, the upper one backward slip; a limit below the kinetic torque counts as that.
    Where all are zero it is open.
    """

    friction = Coulomb(static=1.0, kinetic=1.0)

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side whose motion is positive: slip = follower - base")
    kinetic: SignalLike = signal(
        "N m", "torque while it slips, against the slip; below zero counts as zero", units=("N",), clips=True
    )
    upper: SignalLike = signal("N m", "largest torque that it holds, at least zero", units=("N",))
    lower: SignalLike = signal("N m", "smallest torque that it holds, at most zero", units=("N",))
    tolerance: float = option(
        "rad/s", "slip below which it may lock; 0: at exactly zero", default=1e-3, at_least=0.0, units=("m/s",), last=1
    )
