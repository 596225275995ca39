"""What a System has, in numbers, and as a notebook shows it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from clutchwork.assembly.wiring import wiring
from clutchwork.base import html
from clutchwork.results.ratios import gears, head_of, input_and_output

if TYPE_CHECKING:
    from collections.abc import Iterator

    from clutchwork.assembly.system import System


def sizes(system: System) -> dict[str, int]:
    """How much of what a model has."""
    parts = wiring(system)
    more = {"thermal nodes": parts.thermal, "heat flows": parts.flows, "processes": parts.processes}
    return {
        "shafts and masses": len(parts.nodes),
        "independent speeds": len(system.massless),
        "gear rows": len(parts.gears),
        "torque elements": sum(not branch.hidden for branch in parts.elements),
        "contacts": len(parts.contacts),
        "prescribed speeds": len(parts.motions),
        "inputs": len(parts.inputs),
        **{name: len(things) for name, things in more.items() if things},
    }


def number(value: float | None) -> str:
    """A ratio in words."""
    if value is None:
        return "free"
    return f"{value:.4f}" if math.isfinite(value) else "held"


def parts(system: System) -> tuple[None, list[str]]:
    """Tables of a System in a notebook: what it has, its ratios, and what is to be known about it."""
    return None, list(_tables(system))


def _tables(system: System) -> Iterator[str]:
    yield html.heading(system.name)
    yield html.table(("it has", ""), [(name, count) for name, count in sizes(system).items() if count], right={1})
    # a System that was read from bytes has no names
    shafts = input_and_output(wiring(system)) if system.nodes else None
    found = gears(system, shafts) if shafts is not None else None
    if shafts is not None and found is not None and found.ratios:
        lines = [(" ".join(closed) or "-", number(ratio)) for closed, ratio in found.ratios]
        yield html.table(("closed", head_of(system, shafts)), lines, right={1})
    if found is not None and found.untried is not None:
        yield html.paragraph(f"not tried: {found.untried} or more contacts closed at once")
    for names in system.dependent:
        yield html.paragraph(f"when locked together, these depend on each other: {', '.join(names)}")
    for note in system.notes:
        yield html.paragraph(note)
    for warning in system.warnings:
        yield html.paragraph(f"warning: {warning}")
