"""Drag of a vehicle in the air."""

from __future__ import annotations

from clutchwork.declare import Node, Role, SignalLike, component, param, port, signal
from clutchwork.elements.bases.heating import Heating


@component(Role.TORQUE, hooks=("margin", "cross", "turns", "settle"))
class AirDrag(Heating):
    """Force `-density/2 area u abs(u)` with `u` the speed minus the wind.

    Use it for the drag of a vehicle; `Vehicle` holds one. Work done by a tail wind counts as negative heat.
    """

    shaft: Node = port("mass that moves through the air", domain="translation")
    area: float = param("m2", "frontal area times drag coefficient", at_least=0.0)
    density: float = param("kg/m3", "density of the air", default=1.2, above=0.0)
    wind: SignalLike = signal("m/s", "speed of the air along the road, positive from behind", default=0.0)
