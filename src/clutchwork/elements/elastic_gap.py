"""Elastic contact that opens."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from clutchwork.declare import Node, Role, State, Work, component, option, param, port
from clutchwork.elements.bases.heating import Heating


@component(
    Role.TORQUE,
    states=(State("gap", "rad", "distance left between base and follower, below 0: pressed", span=1e-7),),
    hooks=("margin", "cross", "turns", "settle", "heat"),
)
class ElasticGap(Heating):
    """Spring and damper between two bodies that push while they touch and never pull.

    Use it for bumpers, cushions, valve seats and elastic stops; `EndStop` is rigid. The gap grows where the follower
    moves ahead of the base. Below zero the bodies push each other apart with stiffness depth + damping closing speed,
    the damping never above the force of the spring. It is `ElastoGap` of the Modelica Standard Library 4.0 with n = 1.
    """

    work: ClassVar[Work] = Work.STORE | Work.LOSS
    jumps: ClassVar[bool] = True

    base: Node = port("body that the gap is measured from")
    follower: Node = port("body in front of it, which moves ahead as the gap opens")
    stiffness: float = param("N m/rad", "stiffness of the contact", above=0.0, units=("N/m",), example=1e4)
    damping: float = param("N m s/rad", "damping of the contact", default=0.0, at_least=0.0, units=("N s/m",))
    initial_gap: float = option("rad", "gap at the start, below 0: pressed", default=0.0, units=("m",))

    def initial_states(self) -> tuple[float, ...]:
        """Gap at the start [rad]."""
        return (self.initial_gap,)

    def stored(self, states: Sequence[float], torque: float) -> float:  # noqa: ARG002, its state alone tells
        """Energy of the contact where it is pressed [J]."""
        return 0.5 * self.stiffness * min(states[0], 0.0) ** 2
