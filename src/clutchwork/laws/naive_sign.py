"""Stribeck friction without a stick phase, on which every solver stalls."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Role, component
from clutchwork.laws.bases.stribeck import StribeckCurve


@component(Role.LAW, hooks=("chatters",))
class NaiveSign(StribeckCurve):
    """Coefficient `sign(slip) s(slip) + viscous slip`, zero at zero slip.

    For demonstration only: where the contact should lock, the torque jumps between both signs from step to step, and
    the run ends with the status "chatter". Use `Stribeck`, which sticks exactly.
    """

    sticks: ClassVar[bool] = False
