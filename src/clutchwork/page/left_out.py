"""What pages have no room for: `tools/build_wasm.py` leaves it out of the core that they hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from clutchwork.assembly.system import System

# kinds by role: friction laws whose words would be some kB of every page, and hydraulics
LEFT_OUT: dict[str, tuple[str, ...]] = {
    "law": ("dynamic_formula", "formula"),
    "torque": ("pump_torque",),
    "process": (
        *("accumulator", "hydraulic_oil", "oil_volume", "orifice", "pump_flow", "relief_valve", "spool_valve"),
    ),
}


def absent(system: System) -> Iterator[str]:
    """What of a System no page computes, in words."""
    for contact in system.contacts:
        law = type(contact.friction)
        if getattr(law, "kind", "") in LEFT_OUT["law"]:
            said = f"the friction of {contact.name!r} is a {law.__name__}, which pages have no room for"
            yield f"{said}; take a law of the list, or draw pictures: run.plot"
    for one in (*system.elements, *system.processes):
        kind = type(one)
        if kind.kind in LEFT_OUT.get(kind.role.value, ()):
            yield f"{one.name!r} is a {kind.__name__}, which pages have no room for; draw pictures: run.plot"
