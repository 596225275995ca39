"""Cone clutch."""

from __future__ import annotations

from collections.abc import Iterable
from math import pi, sin

from clutchwork.declare import Component, Node, Role, SignalLike, ThermalNode, component, param, port, signal
from clutchwork.elements.bases.contacts import Contact
from clutchwork.elements.bases.geometry import Found, effective_radius, ring_problems
from clutchwork.elements.plate_contact import PlateContact


@component(Role.COMPOSITE)
class ConeClutch(Contact):
    """Clutch with conical surfaces, which an axial force wedges together.

    The torque is `coefficient force radius / sin(half_angle)`, with the effective radius given or that of the ring that
    the cone covers. Use it for synchronisers and cone brakes.

    Source: R. G. Budynas, J. K. Nisbett, Shigley's Mechanical Engineering Design, cone clutches and brakes, uniform
    pressure.
    """

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side whose motion is positive: slip = follower - base")
    radius: float | None = param(
        "m", "effective radius, in place of the diameters", default=None, above=0.0, example=0.05
    )
    outer_diameter: float | None = param("m", "largest diameter of the contact", default=None, above=0.0)
    inner_diameter: float | None = param("m", "smallest diameter of the contact", default=None, at_least=0.0)
    half_angle: float = param("rad", "angle between the surface and the axis", above=0.0, at_most=pi / 2, example=0.12)
    surfaces: int = param("1", "number of friction surfaces", default=1, above=0.0, whole=True)
    force: SignalLike = signal("N", "axial force; below zero counts as zero", presses=True)

    def problems(self) -> Found:
        return ring_problems(self.radius, self.outer_diameter, self.inner_diameter)

    @property
    def gain(self) -> float:
        """Torque per unit of axial force and coefficient [m]."""
        radius = effective_radius(self.radius, self.outer_diameter, self.inner_diameter)
        return self.surfaces * radius / sin(self.half_angle)

    def parts(self) -> Iterable[Component | ThermalNode]:
        """The contact."""
        yield PlateContact(
            self.name,
            base=self.base,
            follower=self.follower,
            friction=self.friction,
            gain=self.gain,
            normal_force=self.force,
            **self.sticking(),
        )
