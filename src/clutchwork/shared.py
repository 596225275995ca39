"""States that any component may read: heat of thermal nodes, and those of processes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from clutchwork.schema import Role, kinds

if TYPE_CHECKING:
    from clutchwork.inputs import Wires
    from clutchwork.node import ThermalNode
    from clutchwork.pools import Pools


@dataclass(frozen=True)
class Shared:
    """The shared states in order: thermal nodes, then processes.

    That of a thermal mass is the heat that it holds above the start, so its temperature is
    temperature at the start + heat/capacity; that of an ambient is the heat that it took up.
    """

    thermal: tuple[ThermalNode, ...]
    processes: tuple[Any, ...]

    def arrays(self, pools: Pools, wires: Wires, states: list[float]) -> dict[str, Any]:
        """Processes, and the start and scale of all shared states, which follow the given states."""
        scale, offset = list[float](), list[float]()
        for node in self.thermal:
            states.append(0.0)
            scale.append(1.0 if node.capacity is None else 1.0 / node.capacity)
            offset.append(0.0 if node.capacity is None else float(node.temperature))  # type: ignore[arg-type]
        first = list[int]()
        for process in self.processes:
            own = process.initial_states()
            first.append(len(states))
            states += own
            scale += [1.0] * len(own)
            offset += [0.0] * len(own)
        return {
            "process_kind": [kinds(Role.PROCESS).index(process.kind) for process in self.processes],
            "process_param": [pools.add(process, process.name) for process in self.processes],
            "process_input": [wires.connect(process) for process in self.processes],
            "process_state": first,
            "shared_scale": scale,
            "shared_offset": offset,
            "initial_state": states,
        }


def node_of_heat(component: Any) -> ThermalNode | None:
    """Thermal node that takes the heat of an element."""
    node: ThermalNode | None = getattr(component, "heat", None)
    return node
