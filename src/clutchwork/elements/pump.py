"""Pump for oil on a shaft."""

from __future__ import annotations

from collections.abc import Iterable

from clutchwork.declare import Component, Found, Node, Rate, Role, SignalLike, component, param, port, signal
from clutchwork.elements.bases.oil import DENSITY, VISCOSITY, same_ports
from clutchwork.elements.pump_flow import PumpFlow
from clutchwork.elements.pump_torque import PumpTorque


@component(Role.COMPOSITE)
class Pump(Component):
    """Pump driven by a shaft of the driveline: it delivers oil and takes the torque for it.

    It delivers `displacement/(2 pi)` per radian, less a leakage that grows with the pressure and falls with the
    viscosity; from an inlet near vacuum, below 20 kPa absolute, it delivers less. It takes
    `displacement (outlet - inlet)/(2 pi efficiency)` and a drag. A pump named "pump" has `pump.torque` and `pump.work`;
    the energy given to the oil is `pump.oil.energy`, the heat of its losses `pump.oil.loss`. Both together are what it
    took from the shaft. A line with a pump and no outlet bursts: give it a `ReliefValve`.

    Source: J. Ivantysyn, M. Ivantysynova, Hydrostatic Pumps and Motors, 2001, chapter 2.
    """

    shaft: Node = port("shaft that drives the pump")
    base: Node | None = port("its housing", default=None)
    displacement: float = param("m3", "oil per turn", above=0.0, example=1.5e-5)
    efficiency: float = param("1", "hydraulic torque over torque", default=0.9, above=0.0, at_most=1.0)
    drag: float = param("N m s/rad", "torque per speed that it takes without pressure", default=0.0, at_least=0.0)
    slow: float = param("rad/s", "speed around which friction changes its sign", default=5.0, above=0.0)
    leakage: float = param("m3", "leakage per pressure, times the dynamic viscosity", default=0.0, at_least=0.0)
    outlet: SignalLike = signal("Pa", "pressure that it delivers to: a volume", draws=True, example=1e6)
    inlet: SignalLike = signal("Pa", "pressure that it takes oil from", default=0.0, draws=True)
    density: SignalLike = signal("kg/m3", "density of the oil", default=DENSITY, above=0.0)
    viscosity: SignalLike = signal("m2/s", "kinematic viscosity of the oil", default=VISCOSITY, above=0.0)

    def problems(self) -> Found:
        """One volume before and behind it."""
        return same_ports(self)

    def parts(self) -> Iterable[Component]:
        """The torque on the shaft, and the oil."""
        own = {name: getattr(self, name) for name in ("displacement", "efficiency", "drag", "slow", "outlet", "inlet")}
        torque = PumpTorque(self.name, shaft=self.shaft, base=self.base, **own)
        yield torque
        oil = {name: getattr(self, name) for name in ("leakage", "density", "viscosity")}
        yield PumpFlow(f"{self.name}.oil", speed=Rate(torque), **own, **oil)
