"""Torque of a pump for oil."""

from __future__ import annotations

from clutchwork.declare import Component, Node, Role, SignalLike, component, param, port, signal


@component(Role.TORQUE, hooks=("margin", "cross", "turns", "settle"))
class PumpTorque(Component):
    """Torque that a pump takes from its shaft; `Pump` holds one.

    `displacement (outlet - inlet)/(2 pi efficiency)` where it turns forward faster than `slow`, and a drag.
    """

    shaft: Node = port("shaft that drives the pump")
    base: Node | None = port("its housing", default=None)
    displacement: float = param("m3", "oil per turn", above=0.0, example=1.5e-5)
    efficiency: float = param("1", "hydraulic torque over torque", default=0.9, above=0.0, at_most=1.0)
    drag: float = param("N m s/rad", "torque per speed that it takes without pressure", default=0.0, at_least=0.0)
    slow: float = param("rad/s", "speed around which friction changes its sign", default=5.0, above=0.0)
    outlet: SignalLike = signal("Pa", "pressure that it delivers to", example=1e6)
    inlet: SignalLike = signal("Pa", "pressure that it takes oil from", default=0.0)
