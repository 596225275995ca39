"""Where thermal nodes, processes and rates stand in a System: what references between components lead to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from clutchwork.base import dataclass
from clutchwork.declare.node import DIRECT, Component, HeatFlow, Node, Rate, SupplyPower, ThermalNode
from clutchwork.model.parts import sensor_name, state_name

# what of a direction a reference reads
READS = {Rate: "rate", HeatFlow: "heat", SupplyPower: "supply", Node: "rate"}


@dataclass(frozen=True)
class SharedNumbers:
    """Numbers of shared states and directions by name."""

    shared: Mapping[str, int]  # thermal node, or "process.state"
    directions: Mapping[str, int]  # torque element or contact
    processes: Mapping[str, int]
    ways: int  # directions, each way of an element counted

    def of(self, value: Any) -> tuple[str, int]:
        """Sort and number of a reference; ambients are excluded, their temperature is a signal."""
        if isinstance(value, (Node, *DIRECT)):
            acting = value if isinstance(value, Node) else value.of
            name = sensor_name(acting) if isinstance(acting, Node) else acting.name
            return READS[type(value)], self.directions[name]
        return "shared", self.shared[state_name(value)]


def places(thermal: Sequence[ThermalNode], processes: Sequence[Any], acting: Sequence[Component]) -> SharedNumbers:
    """Shared states: thermal nodes, then those of processes; directions: torque elements, then contacts."""
    names = [node.name for node in thermal]
    names += [f"{process.name}.{state.name}" for process in processes for state in type(process).states]
    directions = dict[str, int]()
    for number, component in enumerate(acting):
        # of several ways the first one
        directions.setdefault(component.name, number)
    order = {process.name: number for number, process in enumerate(processes)}
    return SharedNumbers({name: number for number, name in enumerate(names)}, directions, order, len(acting))
