"""The gear elements that a gear set of a gearbox is made of: with losses where its meshes have some."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import sqrt
from typing import TYPE_CHECKING, Any

from clutchwork.declare import HOUSING, Node, Part
from clutchwork.declare.schema import REGISTRY, Role

if TYPE_CHECKING:
    from clutchwork.gearbox.gear_set import GearSet

# kinds of sets that are an element as they stand
PLAIN = {
    "single": "planetary",
    "double": "double_planetary",
    "stepped": "compound_planetary",
    "ravigneaux": "ravigneaux",
}


def train(
    name: str, one: GearSet, nodes: Mapping[str, Node], efficiency: float, heat: Mapping[str, Any]
) -> Iterator[Part]:
    """A gear set as elements on the shafts of its members.

    Parameters: name, of the first element; nodes, by member; efficiency, of the way from wheel to wheel with the
    carrier at rest; heat, where the heat of its meshes goes.
    """
    if efficiency < 1.0:
        yield from _lossy(name, one, nodes, efficiency, heat)
    elif one.kind in PLAIN and not _small_ring(one):
        ports: dict[str, Any] = {port: nodes[member] for port, member in one.members.items()}
        yield REGISTRY[Role.GEAR][PLAIN[one.kind]](name, **ports, **_teeth(one), **one.ratios)
    else:
        for number, (first, second, ratio) in enumerate(one.meshes(), 1):
            ends = _ends(one, nodes, first, second)
            # a fraction keeps the rows exact
            yield REGISTRY[Role.GEAR]["gear"](_numbered(name, number), **ends, ratio=ratio)


def _teeth(one: GearSet) -> dict[str, Any]:
    """The teeth that its ratios follow from."""
    return {f"teeth_{wheel}": one.teeth[wheel] for wheel in _wheels(one)} if one.teeth else {}


def _wheels(one: GearSet) -> list[str]:
    return [name for wheel in one.shape.wheels for name in (wheel.port, wheel.planet) if name]


def _small_ring(one: GearSet) -> bool:
    """Whether the wheel in the place of the ring of a double set is a second sun."""
    return one.kind == "double" and abs(one.meshes()[0][2]) <= Fraction(1)


def _ends(one: GearSet, nodes: Mapping[str, Node], first: str, second: str) -> dict[str, Any]:
    carrier = nodes[one.carrier]
    support = {} if carrier is HOUSING else {"support": carrier}
    return {"input": nodes[first], "output": nodes[second], **support}


def _lossy(
    name: str, one: GearSet, nodes: Mapping[str, Node], efficiency: float, heat: Mapping[str, Any]
) -> Iterator[Part]:
    """A gear with losses from wheel to wheel, carried by the carrier; of more wheels, from each to the planets."""
    lossy = REGISTRY[Role.COMPOSITE]["lossy_gear"]
    if len(one.wheels) == 2:
        ((first, second, ratio),) = one.meshes()
        yield lossy(name, **_ends(one, nodes, first, second), ratio=float(ratio), efficiency=efficiency, **heat)
        return
    planets = Node(f"{name}.planets")
    yield planets
    # on the way from one wheel to another there are two of them
    half = sqrt(efficiency)
    for number, (wheel, size) in enumerate(zip(one.wheels, one.speeds_of_planets(), strict=True), 1):
        ends = {**_ends(one, nodes, wheel, wheel), "output": planets}
        yield lossy(_numbered(name, number), **ends, ratio=float(1 / size), efficiency=half, **heat)


def _numbered(name: str, number: int) -> str:
    return name if number == 1 else f"{name}.mesh_{number}"
