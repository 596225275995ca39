"""Planetary gear with losses."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from clutchwork.declare import Component, Found, Role, component
from clutchwork.elements.bases.meshing import Lossy
from clutchwork.elements.bases.teeth import PlanetarySet
from clutchwork.elements.mesh import Mesh


@component(Role.COMPOSITE)
class LossyPlanetary(PlanetarySet, Lossy):
    """Planetary gear with losses in its meshes, relative to the carrier; their friction sticks exactly.

    Use it where the efficiency of a planetary set counts: it depends on which members drive, and is 1 where the set
    turns as a block. `efficiency` is the product of those of the meshes sun-planet and planet-ring where the sun drives
    as seen from the carrier, `backward_efficiency` where the ring does. Friction and speed of a loss table are those
    of the sun, relative to the carrier.

    Source: C. Pelchen, C. Schweiger, M. Otter, Modeling and simulating the efficiency of gearboxes and of planetary
    gearboxes, 2nd Modelica Conference, 2002.
    """

    def problems(self) -> Found:
        return super().problems() or self.loss_problems()

    def parts(self) -> Iterable[Component]:
        """The mesh between sun and ring, carried by the carrier."""
        ends: dict[str, Any] = {"input": self.sun, "output": self.ring, "support": self.carrier}
        return (Mesh(self.name, ratio=-float(self.exact_ratio()), **ends, **self.mesh()),)
