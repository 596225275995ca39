"""Rack and pinion."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from clutchwork.declare import Component, Found, Node, Role, component, exact, param, port
from clutchwork.elements.bases.meshing import Lossy
from clutchwork.elements.bases.teeth import ratio_problems
from clutchwork.elements.rack_mesh import RackMesh
from clutchwork.elements.rolling_wheel import RollingWheel


@component(Role.COMPOSITE)
class RackPinion(Lossy):
    """Rack that a pinion moves: speed of the mass = radius times speed of the shaft relative to the support.

    Use it for steering gears and linear axes. Give the radius of the pitch circle, or teeth and module: radius =
    module teeth/2. Its losses follow the torque in the mesh, as those of a `LossyGear` whose input is the shaft; it has
    none by default.
    """

    shaft: Node = port("shaft of the pinion", domain="rotation")
    mass: Node = port("rack", domain="translation")
    support: Node | None = port(
        "member that carries the pinion and takes the reaction", default=None, domain="rotation"
    )
    radius: float | None = param("m", "radius of the pitch circle", default=None, above=0.0)
    teeth: int | None = param("1", "teeth of the pinion", default=None, above=0.0, whole=True)
    module: float | None = param("m", "module, diameter of the pitch circle per tooth", default=None, above=0.0)

    def problems(self) -> Found:
        found = ratio_problems(self, "radius", ("teeth", "module"))
        return found or self.loss_problems() or self.heat_problems()

    def exact_radius(self) -> Fraction:
        """Radius of the pitch circle [m] as a fraction."""
        if self.radius is not None:
            return exact(self.radius)
        return exact(self.module or 0) * exact(self.teeth or 0) / 2

    def parts(self) -> Iterable[Component]:
        """The mesh, with its friction where it has losses."""
        ends: dict[str, Any] = {"shaft": self.shaft, "mass": self.mass, "support": self.support}
        radius = float(self.exact_radius())
        if self.is_lossy():
            return (RackMesh(self.name, radius=radius, **ends, **self.mesh()),)
        return (RollingWheel(self.name, radius=radius, **ends),)
