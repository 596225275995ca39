"""Plate with a temperature gradient through its thickness."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from clutchwork.declare import Component, Role, ThermalNode, component, param
from clutchwork.elements.conduction import Conduction


@component(Role.COMPOSITE)
class ThermalPlate(Component):
    """Plate that is heated at its surface: thermal nodes at equal distances, joined by conduction.

    Use it where an engagement is shorter than the time heat takes to cross the plate, thickness^2/diffusivity, so that
    the surface gets far hotter than the mean. Give `plate.surface` as the `heat` of a contact and connect the cooling
    to `plate.back` or `plate.surface`. A plate heated equally at both faces is one of half the thickness and twice the
    area. The error falls as 1/(nodes - 1)^2.

    Source: H. S. Carslaw, J. C. Jaeger, Conduction of Heat in Solids, 2nd ed., Oxford 1959, section 3.8.
    """

    thickness: float = param("m", "distance from the surface to the back", above=0.0)
    area: float = param("m2", "area that the heat crosses", above=0.0)
    conductivity: float = param("W/(m K)", "thermal conductivity", above=0.0)
    density: float = param("kg/m3", "density", above=0.0)
    specific_heat: float = param("J/(kg K)", "specific heat capacity", above=0.0)
    nodes: int = param("1", "thermal nodes through the thickness", default=5, at_least=2, at_most=100, whole=True)
    temperature: float = param("K", "temperature at the start", default=300.0, above=0.0)

    @property
    def surface(self) -> ThermalNode:
        """Node that takes the heat."""
        return self._node(0)

    @property
    def back(self) -> ThermalNode:
        """Node at the other face."""
        return self._node(self.nodes - 1)

    def parts(self) -> Iterator[Component | ThermalNode]:
        """Thermal nodes from the surface to the back, and the conduction between neighbours."""
        made = [self._node(number) for number in range(self.nodes)]
        yield from made
        conductance = self.conductivity * self.area * (self.nodes - 1) / self.thickness
        for number, (hot, cold) in enumerate(pairwise(made), 1):
            yield Conduction(f"{self.name}.conduction_{number}", hot=hot, cold=cold, conductance=conductance)

    def _node(self, number: int) -> ThermalNode:
        """A node holds the heat of half the distance to its neighbours."""
        cells = self.nodes - 1
        share = (0.5 if number in (0, cells) else 1.0) / cells
        capacity = share * self.thickness * self.area * self.density * self.specific_heat
        place = {0: "surface", cells: "back"}.get(number, f"node_{number + 1}")
        return ThermalNode(f"{self.name}.{place}", capacity, self.temperature)
