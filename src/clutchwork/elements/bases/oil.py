"""Inputs and parameters that all orifices for oil share: docs/theory/hydraulics.md (2)."""

from __future__ import annotations

from numbers import Real

from clutchwork.declare import Component, Found, SignalLike, family, param, signal

# an automatic transmission fluid at 80 degrees Celsius
DENSITY, VISCOSITY = 810.0, 9e-6
# a sharp edge: part of the flow that contracts behind it, and Reynolds number at which it becomes turbulent
DISCHARGE, TRANSITION = 0.7, 12.0
# names of ports for oil
PORTS = ("inlet", "outlet", "supply", "clutch", "exhaust")
# of a valve: share of its stroke that its clearance is worth
CLEARANCE = 5e-3


@family
class Opening(Component):
    """An element that oil flows through, turbulent or laminar by its Reynolds number."""

    density: SignalLike = signal("kg/m3", 'density of the oil, as `(oil, "density")`', default=DENSITY, above=0.0)
    viscosity: SignalLike = signal(
        "m2/s", 'kinematic viscosity of the oil, as `(oil, "viscosity")`', default=VISCOSITY, above=0.0
    )
    discharge: float = param("1", "discharge coefficient", default=DISCHARGE, above=0.0)
    transition: float = param("1", "the flow becomes turbulent at this Reynolds number", default=TRANSITION, above=0.0)

    def problems(self) -> Found:
        """One volume at two ports, between which nothing flows."""
        return same_ports(self)


def same_ports(component: Component) -> Found:
    """One volume at two of the ports of an element."""
    there = [name for name in PORTS if hasattr(component, name)]
    found = []
    for place, name in enumerate(there):
        for other in there[:place]:
            one = getattr(component, name)
            if one is getattr(component, other) and not isinstance(one, Real):
                found.append((name, f"is also the {other}", "join it to another volume"))
    return found
