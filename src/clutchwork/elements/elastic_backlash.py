"""Play between elastic flanks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from clutchwork.declare import Node, Role, State, Work, component, flag, option, param, port
from clutchwork.elements.bases.heating import Heating


@component(
    Role.TORQUE,
    states=(State("twist", "rad", "follower - base, 0 in the middle of the gap", span=1e-7),),
    hooks=("margin", "cross", "turns", "settle", "heat"),
)
class ElasticBacklash(Heating):
    """Elastic shaft or tooth with play: no torque inside the gap, a spring and a damper beyond it.

    Use it for gears, splines, couplings and joints whose flanks are elastic; `Backlash` has rigid ones. Beyond half the
    gap the torque on the follower is -(stiffness depth + damping rate), as long as that pushes: flanks never pull.
    `limited`: the damping never exceeds the torque of the spring, so the torque does not jump at contact; otherwise it
    does. They are `ElastoBacklash` (limited) and `ElastoBacklash2` of the Modelica Standard Library 4.0.
    """

    work: ClassVar[Work] = Work.STORE | Work.LOSS
    elastic: ClassVar[bool] = True
    jumps: ClassVar[bool] = True

    base: Node = port("side that the twist is measured from")
    follower: Node = port("side whose motion is positive")
    stiffness: float = param("N m/rad", "stiffness of the flanks", above=0.0, units=("N/m",), example=1e4)
    damping: float = param("N m s/rad", "damping of the flanks", default=0.0, at_least=0.0, units=("N s/m",))
    gap: float = param("rad", "play from one flank to the other", above=0.0, units=("m",), example=0.02)
    limited: bool = flag("damping never above the torque of the spring", default=True)
    initial_twist: float = option("rad", "twist at the start, 0 in the middle of the gap", default=0.0, units=("m",))

    def initial_states(self) -> tuple[float, ...]:
        """Twist at the start [rad]."""
        return (self.initial_twist,)

    def stored(self, states: Sequence[float], torque: float) -> float:  # noqa: ARG002, its state alone tells
        """Energy of the flank that is pressed [J]."""
        return 0.5 * self.stiffness * max(abs(states[0]) - self.gap / 2, 0.0) ** 2
