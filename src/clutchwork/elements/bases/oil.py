"""Inputs and parameters that openings for oil share: docs/theory/hydraulics.md (2)."""

from __future__ import annotations

from clutchwork.declare import Component, SignalLike, family, param, signal

# an automatic transmission fluid at 80 degrees Celsius
DENSITY, VISCOSITY = 810.0, 9e-6
# a sharp edge: part of the flow that contracts behind it, and Reynolds number at which it becomes turbulent
DISCHARGE, TRANSITION = 0.7, 12.0
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
    transition: float = param(
        "1", "number of Reynolds at which the flow becomes turbulent", default=TRANSITION, above=0.0
    )
