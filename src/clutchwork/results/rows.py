"""What stands where in an output row of the core: name and unit of every number."""

from __future__ import annotations

from collections.abc import Iterator

from clutchwork.assembly.shared_states import state_scales
from clutchwork.assembly.wiring import Branch, StateOwner, Wiring
from clutchwork.declare.layout import ROW
from clutchwork.results.channels import ACCELERATION, ANGLE, PLACE, SPEED, TORQUE

Named = tuple[str, str]  # name, what it is with its unit


def numbers(wiring: Wiring) -> list[Named]:
    """Name and meaning of every number of a row, in order."""
    parts = {
        "speed": [(f"{node.name}.speed", SPEED[node.domain]) for node in wiring.nodes],
        "angle": [(f"{node.name}.{PLACE[node.domain]}", ANGLE[node.domain]) for node in wiring.nodes],
        "acceleration": [(f"{node.name}.acceleration", ACCELERATION[node.domain]) for node in wiring.nodes],
        "state": list(_states(wiring)),
        "element_torque": [(f"{part.name}.torque", TORQUE[part.domain]) for part in wiring.elements],
        "contact_torque": [(f"{part.name}.torque", f"{TORQUE[part.domain]}, friction") for part in wiring.contacts],
        "element_work": [(f"{part.name}.work", "J") for part in wiring.elements],
        "contact_work": [(f"{part.name}.work", "J, of friction") for part in wiring.contacts],
        "contact_mode": [(f"{part.name}.mode", "one of model_mode") for part in wiring.contacts],
        "contact_capacity": [(f"{part.name}.capacity", TORQUE[part.domain]) for part in wiring.contacts],
        "flow": [(f"{flow}.heat_flow", "W") for flow in wiring.flows],
        "prescribed_work": [(f"{part.name}.work", "J") for part in wiring.motions],
        "supply_power": [(f"{part.name}.{part.component.supply}_power", "W") for part in wiring.supplies],
        "meter_energy": [(f"{line.name}.energy", "J") for line in wiring.lines],
        "supply_energy": [(f"{part.name}.{part.component.supply}_energy", "J") for part in wiring.supplies],
    }
    known = {name for named in parts.values() for name, _ in named}
    # the torque of a load and the signal that sets its size would have the same name
    parts["input"] = [(f"{name}_signal" if name in known else name, unit) for name, unit in wiring.inputs]
    return [named for part, _ in ROW for named in parts[part]]


def _states(wiring: Wiring) -> Iterator[Named]:
    """States of elements and contacts, then the shared ones: heat of thermal nodes, processes."""
    owners: list[Branch | StateOwner] = [*wiring.elements, *wiring.contacts, *wiring.thermal]
    own = [(index, f"{owner.component.name}.{name}", unit) for owner in owners for name, unit, index in owner.states]
    yield from ((name, unit) for _, name, unit in sorted(own))
    for process in wiring.processes:
        for (name, unit, _), scale in zip(process.states, state_scales(process.component), strict=True):
            yield f"{process.name}.{name}", unit if scale == 1.0 else f"{scale:g} {unit}"
