"""Levers of gear sets: where their members are, exactly; sets that share two members are one lever."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from clutchwork.base import dataclass
from clutchwork.gearbox.gear_set import HOUSING, GearSet

# short names of ports, at the points of a lever
LETTERS = {
    "sun": "S", "ring": "R", "carrier": "C", "second_sun": "S2", "second_ring": "R2", "large_sun": "LS",
    "small_sun": "SS", "first": "1", "second": "2",
}  # fmt: skip


@dataclass(frozen=True)
class Lever:
    """A lever: each of its points has a member and a place, over which speeds are a straight line.

    Parameters: sets, names of the sets that it stands for; places, by member, from 0 to 1; ports, those of a
    member.
    """

    sets: tuple[str, ...]
    places: Mapping[str, Fraction]
    ports: Mapping[str, tuple[tuple[str, str], ...]]

    def label(self, member: str) -> str:
        """What stands at a point: its port where there is one set, its member where there are several."""
        return "/".join(LETTERS[port] for _, port in self.ports[member]) if len(self.sets) == 1 else member


def levers(sets: Sequence[GearSet], *, merged: bool) -> list[Lever]:
    """A lever for each set, or for those together that share two members; one with the turned-over order of points."""
    made = [lever for one in sets if (lever := _lever(one)) is not None]
    if not merged:
        return [_normal(one) for one in made]
    joined = list[Lever]()
    for one in made:
        partner = next((other for other in joined if _union(other, one) is not None), None)
        union = _union(partner, one) if partner is not None else None
        if partner is None or union is None:
            joined.append(one)
            continue
        joined[joined.index(partner)] = union
    return [_normal(one) for one in joined]


def _lever(one: GearSet) -> Lever | None:
    """Speeds over the carrier go as one over what a wheel turns the planets with."""
    if not one.shape.carried:
        # two gears: the housing is the point between them
        first, second = one.speeds_of_planets()
        places = {one.members["first"]: 1 / first, one.members["second"]: 1 / second, HOUSING: Fraction(0)}
        ports = {
            one.members["first"]: ((one.name, "first"),),
            one.members["second"]: ((one.name, "second"),),
            HOUSING: (),
        }
        return Lever((one.name,), places, ports) if len(places) == 3 else None
    places, ports = dict[str, Fraction](), dict[str, tuple[tuple[str, str], ...]]()
    sizes = [1 / size for size in one.speeds_of_planets()]
    for port, place in [*zip((wheel.port for wheel in one.shape.wheels), sizes, strict=True), ("carrier", Fraction(0))]:
        member = one.members[port]
        if member in places and places[member] != place:
            # joined with itself it turns as one block
            return None
        places[member] = place
        ports[member] = (*ports.get(member, ()), (one.name, port))
    return Lever((one.name,), places, ports)


def _union(one: Lever, other: Lever) -> Lever | None:
    """Two levers as one, where they share two members and agree on any third."""
    shared = [member for member in one.places if member in other.places]
    if len(shared) < 2:
        return None
    a, b = shared[:2]
    stretch = (one.places[b] - one.places[a]) / (other.places[b] - other.places[a])
    moved = {m: one.places[a] + stretch * (place - other.places[a]) for m, place in other.places.items()}
    if any(moved[member] != one.places[member] for member in shared):
        return None
    names = dict.fromkeys((*one.ports, *other.ports))
    ports = {member: (*one.ports.get(member, ()), *other.ports.get(member, ())) for member in names}
    return Lever((*one.sets, *other.sets), {**moved, **one.places}, ports)


def _normal(one: Lever) -> Lever:
    """Places from 0 to 1."""
    low, high = min(one.places.values()), max(one.places.values())
    return Lever(one.sets, {m: (place - low) / (high - low) for m, place in one.places.items()}, one.ports)


def turned(one: Lever) -> Lever:
    """The same upside down."""
    return Lever(one.sets, {member: 1 - place for member, place in one.places.items()}, one.ports)
