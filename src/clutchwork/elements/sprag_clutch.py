"""Freewheel that rolls over."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Law, Node, Role, component, law, param, port
from clutchwork.elements.bases.contacts import Contact
from clutchwork.laws.coulomb import Coulomb


@component(Role.CONTACT, hooks=("holding",))
class SpragClutch(Contact):
    """Freewheel with drag whose sprags roll over at the torque `holding`.

    Use it where a freewheel may be overloaded, or where its drag counts. The follower may run ahead of the base
    against the drag; it falls behind only above the holding torque of the sprags. `OneWayClutch` holds any torque.
    """

    one_way: ClassVar[bool] = True

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side that may run ahead: slip = follower - base is not negative until it rolls over")
    friction: Law = law("drag torque over `drag`", default=Coulomb(static=1.0, kinetic=1.0))
    holding: float = param("N m", "torque at which the sprags roll over", above=0.0, units=("N",))
    drag: float = param(
        "N m", "drag while it overruns, and after it has rolled over", default=0.0, at_least=0.0, units=("N",)
    )
