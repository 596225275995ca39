"""Friction brake against the housing."""

from __future__ import annotations

from clutchwork.declare import (
    GAIN_OF_FORCE,
    GAIN_OF_PRESSURE,
    Law,
    Node,
    Role,
    SignalLike,
    component,
    law,
    option,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.heating import Heating


@component(Role.CONTACT)
class Brake(Heating):
    """Clutch whose base is the housing.

    Use it for the brakes of a gearbox and for vehicle brakes. Capacity is `gain * pressure * coefficient`; a
    pressure below zero counts as zero. Give a normal force in place of the pressure where that is known: in N
    with a gain in m, or as a share from 0 to 1 with a gain in N m.
    """

    shaft: Node = port("member that is braked: slip is its speed")
    friction: Law = law("friction coefficient over slip, static coefficient at rest")
    gain: float = param(
        "m3", "torque per unit of pressure and coefficient", above=0.0, units=GAIN_OF_FORCE + GAIN_OF_PRESSURE
    )
    pressure: SignalLike | None = signal(
        "Pa", "pressure on the piston", default=None, gain=GAIN_OF_PRESSURE, presses=True
    )
    normal_force: SignalLike | None = signal(
        "N",
        "force on the linings, or its share, 0 to 1",
        default=None,
        units=("1",),
        gain=GAIN_OF_FORCE,
        instead_of="pressure",
        presses=True,
    )
    tolerance: float = option(
        "rad/s", "speed below which it may lock; 0: at exactly zero", default=0.0, at_least=0.0, units=("m/s",)
    )
    locked: bool = option("1", "locked at the start, by an impulse if necessary", default=False, flag=True)
