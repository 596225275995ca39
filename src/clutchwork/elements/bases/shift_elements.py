"""Shift elements of a gearbox as elements of a driveline: by default values, or by a table of fields without ports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, fields
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from clutchwork.base.frozen import Frozen
from clutchwork.declare import HOUSING, Entry, Node
from clutchwork.declare.schema import REGISTRY, Role, inputs, specs
from clutchwork.gearbox.analysis import capacities, states
from clutchwork.laws.coulomb import Coulomb

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition, ShiftElement

# kind of a shift element -> that of the element in its place
KINDS = {
    "clutch": "clutch",
    "brake": "brake",
    "freewheel": "one_way_clutch",
    "dog": "dog_clutch",
    "synchroniser": "synchroniser",
}
DRAG = "wet_drag"
# wet paper linings; a law of one's own says more
LINING = Coulomb(static=0.13, kinetic=0.11)
PRESSED = 1e6  # Pa, on a closed element where nothing else is said
RESERVE = 1.5  # capacity at this pressure over the most torque that the element carries
# share of the input torque that every element can hold, also where it carries less
LEAST = 0.1
# a dog clutch of the size of a passenger car
DOG = {"teeth": 36, "gap": 0.01, "stiffness": 2e5}
# and such a synchroniser, of brass on steel
CONE = {"friction": Coulomb(static=0.11, kinetic=0.1), "force": 800.0, "radius": 0.035, "half_angle": 0.12}
ROLES = (Role.CONTACT, Role.TORQUE, Role.COMPOSITE)


class Ends(NamedTuple):
    """The shafts that a shift element joins; slip is the speed of the follower over the base."""

    base: Node
    follower: Node


def entry(quantity: str, name: str, table: Any, kind: str, ends: Ends, usual: Mapping[str, Any], closed: bool) -> Entry:
    """The element that a table describes.

    Parameters: kind, where the table says none; usual, values of an element of that kind that the table does not give;
    closed, whether it starts so.
    """
    given = dict(table) if isinstance(table, Mapping) else {}
    wanted = given.pop("type", kind)
    cls = _known(wanted)
    if cls is None:
        return Entry(quantity, wanted, None, None)
    ports = _ports(cls, ends)
    if ports is None:
        return Entry(quantity, wanted, cls, None, fault=_unfit(cls))
    names = {item.name for item, _ in specs(cls)} - ports.keys()
    unknown = tuple(key for key in given if key not in names)
    values = {key: value for key, value in (usual if wanted == kind else {}).items() if key in names}
    values |= {key: value for key, value in given.items() if key in names}
    values |= _started(cls, values, closed)
    missing = {item.name: MISSING for item in fields(cls) if item.name != "name" and item.default is MISSING}
    return Entry(quantity, wanted, cls, cls(name, **{**missing, **values, **ports}), unknown)


def _known(kind: object) -> Any:
    return next((REGISTRY[role][kind] for role in ROLES if isinstance(kind, str) and kind in REGISTRY[role]), None)


def _ports(cls: Any, ends: Ends) -> dict[str, Node] | None:
    """What is at the ports of an element between two shafts; None where it is not one."""
    names = {item.name for item, spec in specs(cls, "port") if spec.domain in ("", "rotation")}
    if len(names) < len(specs(cls, "port")):
        return None
    if names == {"base", "follower"}:
        return {"base": ends.base, "follower": ends.follower}
    if names == {"hub", "forward", "backward"}:
        return {"hub": ends.base, "forward": ends.follower}
    if names == {"shaft", "base"}:
        return {"base": ends.base, "shaft": ends.follower}
    if names == {"shaft"} and HOUSING in ends:
        return {"shaft": ends.base if ends.follower is HOUSING else ends.follower}
    return None


def _unfit(cls: Any) -> tuple[str, str]:
    names = [item.name for item, _ in specs(cls, "port")]
    if names == ["shaft"]:
        return "acts against the housing, and this element joins two members", "give one with base and follower"
    return "is not an element between two shafts", "give a kind with the ports base and follower"


def _started(cls: Any, given: Mapping[str, Any], closed: bool) -> dict[str, Any]:
    """Values with which an element starts closed or open, those that are not given."""
    names = {item.name for item, _ in specs(cls)}
    made: dict[str, Any] = {}
    for ways, spec in inputs(cls):
        pressed = spec.presses and not cls.one_way
        if pressed and not any(given.get(way) is not None for way in ways) and (spec.unit == "Pa" or not closed):
            made[ways[0]] = PRESSED if closed else 0.0
    if {"command", "engaged"} <= names:
        made |= {"command": float(closed), "engaged": closed}
    if closed and "locked" in names and not cls.one_way and getattr(given.get("friction", LINING), "sticks", True):
        made["locked"] = True
    return {name: value for name, value in made.items() if name not in given}


def usual(element: ShiftElement, torque: float) -> dict[str, Any]:
    """Values of an element that nobody gave any, for the most torque [N m] that it carries."""
    if element.kind == "dog":
        return dict(DOG)
    if element.kind == "synchroniser":
        return dict(CONE)
    if element.kind == "freewheel":
        return {}
    return {"friction": LINING, "gain": RESERVE * torque / (PRESSED * LINING.static)}


@lru_cache
def load(box: Definition) -> dict[str, float]:
    """The most that each element carries in any gear, per torque 1 at the input."""
    return {name: max(found.torque, LEAST) for name, found in capacities(box).items()}


@lru_cache
def ratios(box: Definition) -> Mapping[str, float | None]:
    """Ratio of each row of the shift table, None where it gives none."""
    found = states(box)
    return Frozen({gear: found[gear].ratio if gear in found else None for gear in box.gears})
