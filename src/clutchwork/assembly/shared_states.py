"""States that any component may read: heat of thermal nodes, and those of processes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from clutchwork.base import dataclass
from clutchwork.declare.core import number
from clutchwork.declare.node import Component
from clutchwork.declare.ports import thermal_ports
from clutchwork.declare.schema import Role, inputs
from clutchwork.model.parts import state_name

if TYPE_CHECKING:
    from collections.abc import Callable

    from clutchwork.assembly.inputs import Wires
    from clutchwork.assembly.places import SharedNumbers
    from clutchwork.declare.node import Node, ThermalNode
    from clutchwork.model.pools import Pools
    from clutchwork.model.structure import Mechanism


@dataclass(frozen=True)
class Shared:
    """The shared states in order: thermal nodes, then processes.

    That of a thermal mass is the heat that it holds above the start, so its temperature is
    temperature at the start + heat/capacity; that of an ambient is the heat that it took up.
    """

    thermal: tuple[ThermalNode, ...]
    processes: tuple[Any, ...]

    def arrays(self, pools: Pools, wires: Wires, states: list[float], speed: Callable[[Node], float]) -> dict[str, Any]:
        """Processes, and the start and scale of all shared states, which follow the given states.

        Parameters: speed, that of a shaft at the start.
        """
        scale, offset = list[float](), list[float]()
        for node in self.thermal:
            states.append(0.0)
            scale.append(1.0 if node.capacity is None else 1.0 / node.capacity)
            offset.append(0.0 if node.capacity is None else float(node.temperature))  # type: ignore[arg-type]
        first = list[int]()
        for process in self.processes:
            own = state_scales(process)
            first.append(len(states))
            states += [start / unit for start, unit in zip(process.states_at(speed), own, strict=True)]
            scale += own
            offset += [0.0] * len(own)
        return {
            "process_kind": [number(type(process)) for process in self.processes],
            "process_param": [pools.add(process, process.name) for process in self.processes],
            "process_input": [wires.connect(process) for process in self.processes],
            "process_state": first,
            "process_begins": [beginning(process) for process in self.processes],
            **self._draws(wires),
            "shared_scale": scale,
            "shared_offset": offset,
            "initial_state": states,
        }

    def _draws(self, wires: Wires) -> dict[str, Any]:
        """Inputs of processes behind which one stands that gathers."""
        gathering = {process.name for process in self.processes if type(process).gathers}
        found = list[tuple[int, int, int]]()
        for place, process in enumerate(self.processes):
            for port, (names, spec) in enumerate(inputs(type(process))):
                value = getattr(process, names[0])
                owner = state_name(value).rpartition(".")[0] if spec.draws and is_state(value) else ""
                if owner in gathering:
                    found.append((place, port, wires.places.processes[owner]))
        columns = zip(*found, strict=True) if found else ([], [], [])
        return dict(zip(("draw_process", "draw_input", "draw_from"), map(list, columns), strict=True))


def beginning(process: Component) -> int:
    """Which input gives the first state of a process at the start, -1: none."""
    given = process.begins_with()
    return [given in names for names, _ in inputs(type(process))].index(True) if given else -1


def is_state(value: Any) -> bool:
    """Whether an input is given by a state of a process."""
    return isinstance(value, tuple | Component)


def state_scales(process: Any) -> tuple[float, ...]:
    """What one unit of each state of a process is worth."""
    return process.state_scales() or (1.0,) * len(process.states)


def flow_arrays(model: Mechanism, pools: Pools, wires: Wires) -> dict[str, Any]:
    """Flows and the thermal nodes at their ends."""
    flows = model.role(Role.FLOW)
    ends = [[wires.places.shared[node.name] for node in thermal_ports(flow).values()] for flow in flows]
    return {
        "flow_kind": [number(type(flow)) for flow in flows],
        "flow_param": [pools.add(flow, flow.name) for flow in flows],
        "flow_input": [wires.connect(flow) for flow in flows],
        "flow_from": [left for left, _ in ends],
        "flow_to": [entered for _, entered in ends],
    }


def heat_arrays(model: Mechanism, where: SharedNumbers) -> dict[str, Any]:
    """Paths of heat from elements and contacts to thermal nodes."""
    # of several ways the first one has the heat of all
    acting = (*model.role(Role.TORQUE), *model.role(Role.CONTACT))
    paths = [(where.directions[component.name], path) for component in acting if (path := component.heat_path())]
    return {
        "heat_direction": [number for number, _ in paths],
        "heat_to": [where.shared[path.node.name] for _, path in paths],
        "heat_share": [path.share for _, path in paths],
    }
