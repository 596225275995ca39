"""Which parts of the core a model needs: kinds of components and forms of the motion, as a header of the core."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from clutchwork.declare.schema import Role

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

FILE = "parts.gen.hpp"
# arrays with the kinds of each role
KINDS = {
    Role.TORQUE: "element_kind",
    Role.CONTACT: "contact_kind",
    Role.LAW: "contact_law",
    Role.FLOW: "flow_kind",
    Role.PROCESS: "process_kind",
}
SMALL, SPARSE, FULL = 1, 2, 4


def parts(system: System, whole: bool) -> Iterator[str]:
    """The header; registry.gen.hpp includes it where it is there. whole: nothing is left out."""
    yield from ("// What the exported model needs of the core; a System that needs more is refused.", "#pragma once")
    yield from ("// one run at a time", "#define CLUTCHWORK_ALONE")
    if whole:
        return
    for role, array in KINDS.items():
        kinds = set(system.arrays[array].tolist())
        # a switch has at least one case
        mask = sum(1 << kind for kind in kinds) or 1
        yield f"#define CLUTCHWORK_{role.value.upper()} {mask:#x}ull"
    yield f"#define CLUTCHWORK_FORMS {FULL if system.full[0] else SMALL + SPARSE}"
