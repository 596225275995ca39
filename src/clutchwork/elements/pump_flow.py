"""Oil of a pump."""

from __future__ import annotations

from clutchwork.declare import Component, Role, SignalLike, State, component, param, signal
from clutchwork.elements.bases.oil import DENSITY, VISCOSITY


@component(
    Role.PROCESS,
    states=(
        State("energy", "J", "work given to the oil since the start"),
        State("loss", "J", "heat of its friction and its leakage since the start"),
    ),
    hooks=("margin", "cross", "drawn"),
)
class PumpFlow(Component):
    """Oil that a pump delivers at a speed: `displacement speed/(2 pi) - leakage (outlet - inlet)/(dynamic viscosity)`.

    `Pump` holds one. What its shaft gives is `energy` and `loss`.
    """

    displacement: float = param("m3", "oil per turn", above=0.0, example=1.5e-5)
    efficiency: float = param("1", "hydraulic torque over torque", default=0.9, above=0.0, at_most=1.0)
    drag: float = param("N m s/rad", "torque per speed that it takes without pressure", default=0.0, at_least=0.0)
    slow: float = param("rad/s", "speed around which friction changes its sign", default=5.0, above=0.0)
    leakage: float = param("m3", "leakage per pressure, times the dynamic viscosity", default=0.0, at_least=0.0)
    outlet: SignalLike = signal("Pa", "pressure that it delivers to: a volume", draws=True, example=1e6)
    inlet: SignalLike = signal("Pa", "pressure that it takes oil from", default=0.0, draws=True)
    speed: SignalLike = signal("rad/s", "speed of its shaft", example=100.0)
    density: SignalLike = signal("kg/m3", "density of the oil", default=DENSITY, above=0.0)
    viscosity: SignalLike = signal("m2/s", "kinematic viscosity of the oil", default=VISCOSITY, above=0.0)

    def initial_states(self) -> tuple[float, ...]:
        """Nothing yet."""
        return (0.0, 0.0)
