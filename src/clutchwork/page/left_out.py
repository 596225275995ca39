"""What pages have no room for: `tools/build_wasm.py` leaves it out of the core that they hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from clutchwork.assembly.system import System

# friction laws, whose words would be some kB of every page
LAWS = ("dynamic_formula", "formula")


def absent(system: System) -> Iterator[str]:
    """What of a System no page computes, in words."""
    for contact in system.contacts:
        law = type(contact.friction)
        if getattr(law, "kind", "") in LAWS:
            said = f"the friction of {contact.name!r} is a {law.__name__}, which pages have no room for"
            yield f"{said}; take a law of the list, or draw pictures: run.plot"
