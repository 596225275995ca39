"""Electric machines in the drawings of gearboxes."""

from __future__ import annotations

from dataclasses import replace

from clutchwork.diagrams.stick.symbols import MACHINE
from clutchwork.gearbox.definition import ShiftElement
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.gearbox.gearbox import Gearbox


def with_machines(box: Gearbox) -> Gearbox:
    """A gearbox to draw: a machine stands between the housing, which holds its stator, and its member."""
    machines = (ShiftElement(name, MACHINE, HOUSING, member) for name, member in box.machines.items())
    return replace(box, elements=(*box.elements, *machines), machines={})
