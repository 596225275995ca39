"""What the core as WebAssembly says of itself, read without running it."""

from __future__ import annotations

from collections.abc import Iterable

from clutchwork.declare.core import core

MAGIC = b"\0asm\1\0\0\0"
# kinds that the core of a page has no room for, by role: hydraulics
LEFT_OUT = {
    "torque": ("pump_torque",),
    "process": (
        *("accumulator", "hydraulic_oil", "oil_volume", "orifice", "pump_flow", "relief_valve", "spool_valve"),
    ),
}
# a section that tools/build_wasm.py adds
SECTION, CUSTOM = b"clutchwork", 0


def schema_of(module: bytes) -> int | None:
    """The schema hash of a module, as its cw_schema_hash gives it; None where it has none."""
    if not module.startswith(MAGIC):
        return None
    at = len(MAGIC)
    while at < len(module):
        kind, (size, at) = module[at], _number(module, at + 1)
        content, at = module[at : at + size], at + size
        length = len(SECTION) + 1
        if kind == CUSTOM and content[:length] == bytes([len(SECTION)]) + SECTION:
            return int(content[length:])
    return None


def left_out(kinds: Iterable[tuple[str, str]]) -> list[str]:
    """Kinds, given by role and name, that the core of a page does not have."""
    return sorted({kind for role, kind in kinds if kind in LEFT_OUT.get(role, ())})


def fits(module: bytes) -> bool:
    """Whether a module was built from the declarations of the compiled core here: it then reads the same systems."""
    return schema_of(module) == int(core().schema_hash())


def _number(module: bytes, at: int) -> tuple[int, int]:
    """A number in groups of seven bits, the lowest first, and where it ends."""
    value = shift = 0
    while True:
        byte = module[at]
        value, shift, at = value | (byte & 127) << shift, shift + 7, at + 1
        if byte < 128:
            return value, at
