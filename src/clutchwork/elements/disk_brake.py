"""Disc brake."""

from __future__ import annotations

from collections.abc import Iterable
from math import pi

from clutchwork.declare import HOUSING, Component, Node, Role, SignalLike, ThermalNode, component, param, port, signal
from clutchwork.elements.bases.contacts import Contact
from clutchwork.elements.plate_contact import PlateContact


@component(Role.COMPOSITE)
class DiskBrake(Contact):
    """Disc brake: pistons press pads on both sides of a disc.

    The torque is `coefficient pressure (pi/4 bore^2) radius pads`. Use it for the brakes of vehicles and machines, with
    one pad for each piston side of a calliper.

    Source: R. G. Budynas, J. K. Nisbett, Shigley's Mechanical Engineering Design, caliper brakes.
    """

    shaft: Node = port("disc: slip is its speed relative to the base")
    base: Node | None = port("member that takes the reaction", default=None)
    radius: float = param("m", "mean radius of the pads", above=0.0)
    bore: float = param("m", "diameter of each piston", above=0.0)
    pads: int = param("1", "number of pads", default=2, above=0.0, whole=True)
    pressure: SignalLike | None = signal(
        "Pa", "pressure on the pistons; below zero counts as zero", default=None, presses=True
    )
    normal_force: SignalLike | None = signal(
        "N", "force on each pad", default=None, instead_of="pressure", presses=True
    )

    @property
    def gain(self) -> float:
        """Torque per unit of pressure [m3] or of force [m] and coefficient."""
        area = 1.0 if self.pressure is None else pi / 4 * self.bore**2
        return self.pads * self.radius * area

    def parts(self) -> Iterable[Component | ThermalNode]:
        """The contact."""
        yield PlateContact(
            self.name,
            base=self.base or HOUSING,
            follower=self.shaft,
            friction=self.friction,
            gain=self.gain,
            pressure=self.pressure,
            normal_force=self.normal_force,
            **self.sticking(),
        )
