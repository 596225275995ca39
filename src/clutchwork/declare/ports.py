"""What is attached to the ports of an element."""

from __future__ import annotations

from clutchwork.declare.node import HOUSING, Component, Node, ThermalNode
from clutchwork.declare.schema import specs


def ports(component: Component) -> dict[str, Node]:
    """Nodes at the ports of an element; an optional port that is not given is the housing."""
    return {item.name: getattr(component, item.name) or HOUSING for item, _ in specs(type(component), "port")}


def ends(component: Component) -> tuple[Node, Node]:
    """What the rate of an element is counted of and from: follower and base, or shaft and base."""
    joined = ports(component)
    return joined["follower"] if "follower" in joined else joined["shaft"], joined.get("base", HOUSING)


def thermal_ports(component: Component) -> dict[str, ThermalNode]:
    """Thermal nodes at the ports of an element, those that are given."""
    values = {item.name: getattr(component, item.name) for item, _ in specs(type(component), "thermal")}
    return {name: node for name, node in values.items() if node is not None}
