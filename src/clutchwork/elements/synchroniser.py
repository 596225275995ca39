"""Synchroniser of a gearbox."""

from __future__ import annotations

from collections.abc import Iterable
from math import pi, sin

from clutchwork.declare import (
    Component,
    Law,
    Node,
    Role,
    SignalLike,
    ThermalNode,
    component,
    law,
    option,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.geometry import Found
from clutchwork.elements.bases.heating import Heating
from clutchwork.elements.dog_clutch import DogClutch, gap_problems
from clutchwork.elements.plate_contact import PlateContact


@component(Role.COMPOSITE)
class Synchroniser(Heating):
    """Double-sided synchroniser: one sleeve that joins its hub to one of two gears, or to none.

    On each side a cone brings the gear to the speed of the hub, with the torque `coefficient force radius /
    sin(half_angle)`; once the slip is below `speed` the pointed teeth of the dog clutch engage and carry any torque. A
    command from 0 to 1 shifts to the forward gear, from 0 to -1 to the backward one. Use it for the shifts of manual
    and automated gearboxes.

    Its parts are "forward_cone", "forward_dog", "backward_cone", "backward_dog".
    """

    hub: Node = port("shaft with the sleeve")
    forward: Node = port("gear of positive commands")
    backward: Node | None = port("gear of negative commands, none: single-sided", default=None)
    friction: Law = law("friction coefficient of the cones")
    force: float = param("N", "axial force on the cone at full command", above=0.0)
    radius: float = param("m", "effective radius of the cones", above=0.0)
    half_angle: float = param("rad", "angle between the surface of the cones and the axis", above=0.0, at_most=pi / 2)
    surfaces: int = param("1", "friction surfaces of each cone", default=1, above=0.0, whole=True)
    teeth: int = param("1", "number of dog teeth", default=36, above=0.0, whole=True)
    gap: float = param("rad", "total backlash of a tooth in its gap", default=0.01, above=0.0)
    stiffness: float = param("N m/rad", "stiffness of the flanks", default=1e5, above=0.0)
    damping: float = param("s/rad", "damping of the flanks over their force", default=1.0, at_least=0.0)
    speed: float = param("rad/s", "slip above which the sleeve is held back", default=1.0, above=0.0)
    lag: float = param("s", "time constant of the sleeve", default=0.02, above=0.0)
    command: SignalLike = signal("1", "commanded position of the sleeve: 1 forward, 0 neutral, -1 backward")
    engaged: bool = option("1", "the forward gear is in mesh at the start", default=False, flag=True)
    engaged_backward: bool = option("1", "the backward gear is in mesh at the start", default=False, flag=True)

    def problems(self) -> Found:
        found = gap_problems(self.gap, self.teeth)
        if self.engaged and self.engaged_backward:
            found.append(("engaged_backward", "is given together with engaged", "one sleeve is in one gear"))
        if self.engaged_backward and self.backward is None:
            found.append(("engaged_backward", "needs a backward gear", "give `backward`"))
        return found

    def parts(self) -> Iterable[Component | ThermalNode]:
        """A cone and a dog clutch for each gear."""
        sides = (("forward", self.forward, False), ("backward", self.backward, True))
        for side, gear, reversed_ in sides:
            if gear is not None:
                yield self._cone(side, gear, reversed_)
                yield self._dog(side, gear, reversed_)

    def _cone(self, side: str, gear: Node, reversed_: bool) -> PlateContact:
        return PlateContact(
            f"{self.name}.{side}_cone",
            base=self.hub,
            follower=gear,
            friction=self.friction,
            gain=self.surfaces * self.radius / sin(self.half_angle) * self.force,
            normal_force=self.command,
            reversed=reversed_,
            heat=self.heat,
            heat_share=self.heat_share,
        )

    def _dog(self, side: str, gear: Node, reversed_: bool) -> DogClutch:
        return DogClutch(
            f"{self.name}.{side}_dog",
            base=self.hub,
            follower=gear,
            teeth=self.teeth,
            gap=self.gap,
            stiffness=self.stiffness,
            damping=self.damping,
            speed=self.speed,
            lag=self.lag,
            pointed=True,
            reversed=reversed_,
            command=self.command,
            engaged=self.engaged_backward if reversed_ else self.engaged,
            heat=self.heat,
            heat_share=self.heat_share,
        )
