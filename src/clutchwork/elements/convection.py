"""Heat convection that depends on a speed."""

from __future__ import annotations

from clutchwork.declare import Component, Points, Role, SignalLike, ThermalNode, component, curve, port, signal


@component(Role.FLOW, hooks=("margin", "cross"))
class Convection(Component):
    """Heat flow `conductance * (temperature of hot - temperature of cold)`, its conductance a table over abs(speed).

    Use it for a drum or a clutch cover that cools better the faster it turns. Beyond the ends of the table the
    conductance stays at its last value.
    """

    hot: ThermalNode = port("node that the heat leaves if it is warmer", domain="thermal")
    cold: ThermalNode = port("node that the heat enters", domain="thermal")
    conductance: Points | float = curve(
        "rad/s", "W/K", "conductance over abs(speed), or a number", units_x=("m/s",), at_least=0.0, constant=True
    )
    speed: SignalLike | None = signal(
        "rad/s", "shaft whose speed counts, or a speed", default=None, units=("m/s",), otherwise=0.0
    )
