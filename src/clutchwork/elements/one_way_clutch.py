"""Freewheel with an optional friction clutch in parallel."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import (
    GAIN_OF_FORCE,
    GAIN_OF_PRESSURE,
    Law,
    Node,
    Role,
    SignalLike,
    component,
    law,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.contacts import Pressed
from clutchwork.laws.coulomb import Coulomb


@component(Role.CONTACT)
class OneWayClutch(Pressed):
    """Freewheel: the follower may run ahead of the base and never falls behind it.

    Use it for sprag clutches, roller clutches and ratchets. While locked it transmits any torque that would make the
    slip negative. The friction clutch in parallel has the capacity `gain * pressure * coefficient`, none by default.
    """

    one_way: ClassVar[bool] = True

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side that may run ahead: slip = follower - base is never negative")
    friction: Law = law("friction of the clutch in parallel", default=Coulomb(static=0.1, kinetic=0.1))
    gain: float = param(
        "m3",
        "torque per unit of pressure and coefficient",
        default=1.0,
        above=0.0,
        units=GAIN_OF_FORCE + GAIN_OF_PRESSURE,
    )
    pressure: SignalLike | None = signal(
        "Pa",
        "pressure on the clutch in parallel, 0 by default",
        default=None,
        gain=GAIN_OF_PRESSURE,
        otherwise=0.0,
        presses=True,
    )
