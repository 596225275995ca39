"""Worm gear."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from clutchwork.declare import Component, Found, Node, Role, component, param, port
from clutchwork.elements.bases.contacts import Sticking
from clutchwork.elements.bases.meshing import screw_efficiencies, screw_problems
from clutchwork.elements.mesh import Mesh


@component(Role.COMPOSITE)
class WormGear(Sticking):
    """Worm gear with the sliding friction of its flanks; self-locking if the lead angle is small.

    Use it for hoists, steering and seat drives. With `rho = atan(coefficient/cos(normal_angle))` its efficiency is
    `tan(lead)/tan(lead + rho)` where the worm drives, and `tan(lead - rho)/tan(lead)` where the wheel does. If that is
    not positive, lead <= rho, no load at the wheel can drive the worm, and lowering needs power.
    """

    worm: Node = port("worm shaft, whose speed is ratio times that of the wheel")
    wheel: Node = port("worm wheel")
    support: Node | None = port("member that carries both and takes the reaction", default=None)
    ratio: float = param("1", "speed of the worm over speed of the wheel", example=30.0)
    lead_angle: float = param("rad", "lead angle of the worm", above=0.0, below=1.5707963, example=0.1)
    friction_coefficient: float = param("1", "of the flanks", at_least=0.0, example=0.05)
    normal_angle: float = param("rad", "pressure angle in the normal section", default=0.349, at_least=0.0, below=1.5)

    def problems(self) -> Found:
        if self.ratio == 0:
            return [("ratio", "is zero", "give a number other than zero")]
        return screw_problems(self.lead_angle, self.friction_coefficient, self.normal_angle)

    def parts(self) -> Iterable[Component]:
        """The mesh with its friction."""
        ahead, back = screw_efficiencies(self.lead_angle, self.friction_coefficient, self.normal_angle)
        ends: dict[str, Any] = {"input": self.worm, "output": self.wheel, "support": self.support}
        return (
            Mesh(self.name, ratio=self.ratio, loss_table=((0.0, ahead, back, 0.0, 0.0),), **ends, **self.sticking()),
        )
