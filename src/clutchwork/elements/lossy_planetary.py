"""Planetary gear with losses."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from clutchwork.declare import Component, Found, Node, Role, component, param, port
from clutchwork.elements.bases.meshing import Lossy
from clutchwork.elements.bases.teeth import ring_problems
from clutchwork.elements.mesh import Mesh


@component(Role.COMPOSITE)
class LossyPlanetary(Lossy):
    """Planetary gear with losses in its meshes, which work relative to the carrier; it sticks exactly, by load.

    Use it where the efficiency of a planetary set counts: it depends on which members drive, and is 1 where the set
    turns as a block. `efficiency` is the product of those of the meshes sun-planet and planet-ring where the sun drives
    as seen from the carrier, `backward_efficiency` where the ring does. Friction and speed of a loss table are those
    of the sun, relative to the carrier.

    Source: C. Pelchen, C. Schweiger, M. Otter, Modeling and simulating the efficiency of gearboxes and of planetary
    gearboxes, 2nd Modelica Conference, 2002.
    """

    sun: Node = port("sun wheel")
    ring: Node = port("ring wheel")
    carrier: Node = port("carrier of the planets")
    ratio: float | None = param("1", "teeth of the ring over teeth of the sun", default=None, above=0.0)
    teeth_sun: int | None = param("1", "teeth of the sun", default=None, above=0.0, whole=True)
    teeth_ring: int | None = param("1", "teeth of the ring, counted positive", default=None, above=0.0, whole=True)

    def problems(self) -> Found:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        return ring_problems(self) or self.loss_problems()

    def parts(self) -> Iterable[Component]:
        """The mesh between sun and ring, carried by the carrier."""
        ratio = self.ratio if self.ratio is not None else (self.teeth_ring or 0) / (self.teeth_sun or 1)
        ends: dict[str, Any] = {"input": self.sun, "output": self.ring, "support": self.carrier}
        return (Mesh(self.name, ratio=-ratio, **ends, **self.mesh()),)
