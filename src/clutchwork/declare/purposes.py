"""Groups of the reference: what components are for, from their declarations."""

from __future__ import annotations

from typing import Any

from clutchwork.declare.node import Work
from clutchwork.declare.schema import REGISTRY, Role, specs

CLUTCHES = "Clutches: friction between two shafts"
BRAKES = "Brakes and bearings: friction on one shaft"
GEARS = "Gears and wheels"
SPRINGS = "Springs, dampers and drag"
TORQUES = "Engines, loads and other torques"
MOTION = "Prescribed motion"
PROCESSES = "Actuators, springs that press, and wear"
HEAT = "Heat"
SENSORS = "Sensors"
ELEMENTS = (CLUTCHES, BRAKES, GEARS, SPRINGS, TORQUES, MOTION, PROCESSES, HEAT, SENSORS)
STICKING = "Laws that stick: a contact locks and breaks away exactly"
COMPLIANT = "Compliant laws: a function of slip and states of their own, they never lock"
LAWS = (STICKING, COMPLIANT)
SIGNALS = ("Values over time",)
_BY_ROLE = {Role.GEAR: GEARS, Role.MOTION: MOTION, Role.PROCESS: PROCESSES, Role.FLOW: HEAT}


def purpose(cls: Any) -> str:
    """The group of an element, law or signal."""
    if cls.role is Role.SIGNAL:
        return SIGNALS[0]
    if cls.role is Role.LAW:
        return STICKING if cls.sticks else COMPLIANT
    if cls.kind.endswith("sensor"):
        return SENSORS
    return _BY_ROLE.get(cls.role) or _of_element(cls)


def _of_element(cls: Any) -> str:
    ports = [item.name for item, _ in specs(cls, "port")]
    if not ports:
        return HEAT
    if cls.role is Role.CONTACT or cls.kind.endswith("clutch") or specs(cls, "law"):
        return BRAKES if ports[0] == "shaft" else CLUTCHES
    return TORQUES if Work.SOURCE in cls.work else SPRINGS


def groups(*roles: Role) -> dict[str, dict[str, Any]]:
    """Declarations by purpose and kind, in the order of the reference."""
    found: dict[str, dict[str, Any]] = {name: {} for name in (*ELEMENTS, *LAWS, *SIGNALS)}
    for role in roles:
        for kind, cls in REGISTRY[role].items():
            found[purpose(cls)][kind] = cls
    return {name: dict(sorted(kinds.items())) for name, kinds in found.items() if kinds}


ELEMENT_ROLES = tuple(role for role in Role if role not in (Role.LAW, Role.SIGNAL))
