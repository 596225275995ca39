"""Heat conduction between two thermal nodes."""

from __future__ import annotations

from clutchwork.declare import Component, Role, ThermalNode, component, param, port


@component(Role.FLOW)
class Conduction(Component):
    """Heat flow `conductance * (temperature of hot - temperature of cold)`, reversed when cold is the warmer one.

    Use it for heat through a wall, a joint or a film, where the conductance area * conductivity / thickness is
    known. For one that grows with a speed take `Convection`, for the inside of a plate `ThermalPlate`.
    """

    hot: ThermalNode = port("node that the heat leaves if it is warmer", domain="thermal")
    cold: ThermalNode = port("node that the heat enters", domain="thermal")
    conductance: float = param("W/K", "heat flow per difference of temperature", at_least=0.0)
