"""Friction of a bearing."""

from __future__ import annotations

from clutchwork.declare import Law, Node, Role, component, law, option, param, port
from clutchwork.elements.bases.heating import Heating


@component(Role.CONTACT)
class BearingFriction(Heating):
    """Friction torque `torque * coefficient` that sticks exactly at rest.

    Use it for bearings, seals and guides with a constant load. With a coefficient of 1 in the law, `torque` is the
    friction torque itself.
    """

    shaft: Node = port("shaft that is braked: slip is its speed relative to the base")
    base: Node | None = port("member that takes the reaction", default=None)
    friction: Law = law("friction coefficient over slip, static coefficient at rest")
    torque: float = param("N m", "torque per unit of coefficient", above=0.0, units=("N",))
    tolerance: float = option(
        "rad/s", "slip below which it may lock; 0: at exactly zero", default=0.0, at_least=0.0, units=("m/s",)
    )
    locked: bool = option("1", "locked at the start, by an impulse if necessary", default=False, flag=True)
