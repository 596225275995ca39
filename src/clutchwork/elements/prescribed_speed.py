"""Prescribed speed of a shaft."""

from __future__ import annotations

from clutchwork.declare import Component, Node, Role, SignalLike, component, option, port, signal


@component(Role.MOTION)
class PrescribedSpeed(Component):
    """Source that gives a shaft exactly the wanted speed, whatever torque that takes.

    Use it for a speed-controlled test bench or a shaft whose speed was measured; its torque is part of the result.
    A jump of the speed becomes an impulse. With `cutoff` the speed follows the signal through a first-order
    low pass, d(speed)/dt = 2 pi cutoff (signal - speed), solved exactly; pulses and functions cannot pass it.
    """

    shaft: Node = port("shaft whose speed is given")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    speed: SignalLike = signal("rad/s", "wanted speed", units=("m/s",))
    cutoff: float | None = option("Hz", "corner frequency of the low pass, none by default", default=None, above=0.0)
