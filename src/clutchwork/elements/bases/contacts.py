"""Common base of contacts, and of composites that are built around one."""

from __future__ import annotations

from typing import Any

from clutchwork.declare import GAIN_OF_FORCE, GAIN_OF_PRESSURE, Law, SignalLike, family, law, option, param, signal
from clutchwork.elements.bases.heating import Heating


@family
class Sticking(Heating):
    """An element that slips, locks exactly and breaks away."""

    tolerance: float = option(
        "rad/s", "slip below which it may lock; 0: at exactly zero", default=0.0, at_least=0.0, units=("m/s",), last=1
    )
    locked: bool = option("1", "locked at the start, by an impulse if necessary", default=False, flag=True, last=1)

    def sticking(self) -> dict[str, Any]:
        """What the contact inside of a composite has of it."""
        return {name: getattr(self, name) for name in ("tolerance", "locked", "heat", "heat_share")}


@family
class Contact(Sticking):
    """The same with a friction law."""

    friction: Law = law("friction coefficient over slip, static coefficient at rest")


@family
class Pressed(Contact):
    """A contact with the capacity `gain * pressure * coefficient`, or with a normal force in place of the pressure."""

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
