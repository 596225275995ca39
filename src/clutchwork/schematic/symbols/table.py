"""Which symbol belongs to an element: its own, or one that follows from its declaration."""

from __future__ import annotations

from typing import Any

from clutchwork.declare.schema import Role, specs
from clutchwork.schematic.symbols.contacts import CONTACTS
from clutchwork.schematic.symbols.gears import GEARS
from clutchwork.schematic.symbols.heat import FLOW, FLOWS, PROCESS, PROCESSES
from clutchwork.schematic.symbols.hydraulic import HYDRAULIC, HYDRODYNAMIC
from clutchwork.schematic.symbols.meshes import MESHES
from clutchwork.schematic.symbols.play import PLAY
from clutchwork.schematic.symbols.ratios import RATIOS
from clutchwork.schematic.symbols.symbol import Symbol
from clutchwork.schematic.symbols.torques import TORQUES, unknown
from clutchwork.schematic.symbols.vehicles import VEHICLES

OWN = {
    **CONTACTS,
    **GEARS,
    **MESHES,
    **RATIOS,
    **TORQUES,
    **PLAY,
    **HYDRAULIC,
    **HYDRODYNAMIC,
    **FLOWS,
    **PROCESSES,
    **VEHICLES,
}


def symbol_of(element: Any) -> Symbol:
    """The symbol of an element."""
    found = OWN.get(str(getattr(element, "kind", "")))
    return found or by_declaration(element)


def by_declaration(element: Any) -> Symbol:
    """A symbol for what has none of its own, by its role and its ports."""
    role, ports = getattr(element, "role", None), [item.name for item, _ in specs(type(element), "port")]
    if role is Role.FLOW:
        return FLOW
    if role is Role.PROCESS:
        return PROCESS
    if role is Role.CONTACT and len(ports) <= 2:
        return CONTACTS["one_way_clutch" if element.one_way else "clutch"]
    if role is Role.MOTION:
        return TORQUES["prescribed_speed"]
    if role is Role.TORQUE and "shaft" in ports:
        return TORQUES["torque"]
    # ports one below the other
    step = 14.0 if len(ports) > 2 else 0.0
    middle = 0.5 * step * (len(ports) - 1)
    pins = {port: middle - step * number for number, port in enumerate(ports)}
    return Symbol(unknown, 17.0, middle + 11.0, middle + 11.0, pins)
