"""Friction plates on their own: the contact inside clutches and brakes."""

from __future__ import annotations

from clutchwork.declare import (
    GAIN_OF_FORCE,
    GAIN_OF_PRESSURE,
    Node,
    Role,
    SignalLike,
    choice,
    component,
    flag,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.contacts import Contact


@component(Role.CONTACT, hooks=("fault", "fault_kind", "fault_report"))
class PlateContact(Contact):
    """Contact with the load `gain * derating * (pressure - threshold)`, that can wear and fail.

    Use it to build couplings of your own; `DiskClutch` computes its gain from the geometry and adds drag and heat. The
    derating falls from 1 to `worn` as the depth of wear passes `running_in`.
    """

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side whose motion is positive: slip = follower - base")
    gain: float = param(
        "m3", "torque per unit of pressure and coefficient", above=0.0, units=GAIN_OF_FORCE + GAIN_OF_PRESSURE
    )
    threshold: float = param("Pa", "pressure below which it is open", default=0.0, at_least=0.0, units=("N", "1"))
    worn: float = param("1", "derating of worn plates", default=1.0, above=0.0)
    running_in: float = param("m", "depth of wear over which it nears `worn`, by 1/e", default=1e-4, above=0.0)
    touch_shift: float = param("Pa/m", "rise of the threshold with wear", default=0.0, units=("N/m", "1/m"))
    reversed: bool = flag("a negative pressure closes it", default=False)
    fault: str = choice(
        "what fails: nothing, it opens permanently, or it stays locked once it has locked",
        choices=("none", "cannot_transmit", "cannot_unlock"),
        default="none",
    )
    report: str = choice(
        "effect of a fault: an event, a warning as well, or the end of the run",
        choices=("none", "warning", "error"),
        default="warning",
    )
    pressure: SignalLike | None = signal("Pa", "pressure on the piston", default=None, gain=GAIN_OF_PRESSURE)
    normal_force: SignalLike | None = signal(
        "N",
        "force on the linings, or its share, 0 to 1",
        default=None,
        units=("1",),
        gain=GAIN_OF_FORCE,
        instead_of="pressure",
    )
    wear: SignalLike | None = signal("m", "depth of wear, none below zero", default=None, otherwise=0.0, clips=True)
    fault_signal: SignalLike | None = signal("1", "triggers the fault above 0.5", default=None, otherwise=0.0)
    fault_time: SignalLike | None = signal("1", "triggers it above 0.5 as well", default=None, otherwise=0.0)

    def takes_off(self) -> tuple[str, str]:
        return "pressure", "threshold"

    def fault_warning(self) -> str:
        """What to warn of when its fault is triggered."""
        return self.fault.replace("_", " ") if self.report == "warning" else ""
