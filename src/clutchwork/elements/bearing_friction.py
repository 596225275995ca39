"""Friction of a bearing."""

from __future__ import annotations

from clutchwork.declare import Node, Role, component, param, port
from clutchwork.elements.bases.contacts import Contact


@component(Role.CONTACT)
class BearingFriction(Contact):
    """Friction torque `torque * coefficient` that sticks exactly at rest.

    Use it for bearings, seals and guides with a constant load. With a coefficient of 1 in the law, `torque` is the
    friction torque itself.
    """

    shaft: Node = port("shaft that is braked: slip is its speed relative to the base")
    base: Node | None = port("member that takes the reaction", default=None)
    torque: float = param("N m", "torque per unit of coefficient", above=0.0, units=("N",))
