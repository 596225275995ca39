"""Heat carried away by a flow of oil."""

from __future__ import annotations

from clutchwork.declare import Component, Role, SignalLike, ThermalNode, component, param, port, signal


@component(Role.FLOW)
class OilFlow(Component):
    """Heat flow `flow * heat_capacity * (temperature of hot - temperature of inlet)` that oil carries away.

    Use it for a wet clutch that oil flows through: the oil enters with the temperature of the inlet and leaves with
    that of the node. The inlet, an ambient as a rule, takes the heat. A flow below zero counts as zero.
    """

    hot: ThermalNode = port("node that the oil cools", domain="thermal")
    inlet: ThermalNode = port("node that the oil comes from and carries the heat to", domain="thermal")
    flow: SignalLike = signal("kg/s", "flow of oil; below zero counts as zero", clips=True)
    heat_capacity: float = param("J/(kg K)", "specific heat capacity of the oil", default=2000.0, above=0.0)
