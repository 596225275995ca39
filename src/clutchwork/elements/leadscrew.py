"""Leadscrew."""

from __future__ import annotations

from collections.abc import Iterable
from math import atan, tau
from typing import Any

from clutchwork.declare import Component, Found, Node, Role, component, option, param, port
from clutchwork.elements.bases.contacts import Sticking
from clutchwork.elements.bases.meshing import screw_efficiencies, screw_problems
from clutchwork.elements.rack_mesh import RackMesh


@component(Role.COMPOSITE)
class Leadscrew(Sticking):
    """Screw that moves a mass by its nut, with the friction of its thread; self-locking if its lead is small.

    Use it for lifting tables, presses and linear axes. One turn of the screw moves the mass by the lead. The lead angle
    is `atan(lead/(2 pi radius))`; efficiencies as of a `WormGear`.
    """

    screw: Node = port("screw", domain="rotation")
    mass: Node = port("nut and what it moves", domain="translation")
    support: Node | None = port("member that carries the screw and takes its reaction", default=None, domain="rotation")
    lead: float = param("m", "travel per turn", above=0.0, example=0.005)
    radius: float = param("m", "mean radius of the thread", above=0.0, example=0.01)
    friction_coefficient: float = param("1", "of the thread", at_least=0.0, example=0.1)
    normal_angle: float = param("rad", "flank angle in the normal section", default=0.349, at_least=0.0, below=1.5)
    tolerance: float = option(
        "rad/s", "slip below which it may lock; 0: at exactly zero", default=0.0, at_least=0.0, last=1
    )

    def problems(self) -> Found:
        return screw_problems(self.lead_angle, self.friction_coefficient, self.normal_angle)

    @property
    def lead_angle(self) -> float:
        """Lead angle of the thread [rad]."""
        return atan(self.lead / (tau * self.radius))

    def parts(self) -> Iterable[Component]:
        """The mesh of screw and nut with friction."""
        ahead, back = screw_efficiencies(self.lead_angle, self.friction_coefficient, self.normal_angle)
        ends: dict[str, Any] = {"shaft": self.screw, "mass": self.mass, "support": self.support}
        return (
            RackMesh(
                self.name, radius=self.lead / tau, loss_table=((0.0, ahead, back, 0.0, 0.0),), **ends, **self.sticking()
            ),
        )
