"""What follows for a whole gearbox from its gears: swaps of elements between gears, capacities."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import combinations, permutations
from math import isnan
from typing import TYPE_CHECKING

from clutchwork.base import dataclass
from clutchwork.gearbox.motion import combination
from clutchwork.gearbox.state import GearState, state

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition


@dataclass(frozen=True)
class Swap:
    """What a shift from one gear to another takes: the elements that open and those that close.

    `step` is the ratio of the first gear over that of the second: above 1 for an upshift.
    """

    before: str
    after: str
    opens: tuple[str, ...]
    closes: tuple[str, ...]
    step: float

    @property
    def kind(self) -> str:
        """Whether one, two or more elements are exchanged: "single", "double", "triple" and so on."""
        count = max(len(self.opens), len(self.closes))
        return {0: "none", 1: "single", 2: "double", 3: "triple"}.get(count, f"{count} elements")


@dataclass(frozen=True)
class Capacity:
    """The torque that an element must hold: the largest over all gears, per torque 1 at the input.

    Of elements that share a torque each must hold what it has where the others give way.
    """

    element: str
    torque: float
    gear: str
    gears: tuple[str, ...]  # in which it is closed
    slip: float  # largest slip while it is open, per speed 1 of the input
    slip_gear: str


def states(box: Definition) -> dict[str, GearState]:
    """All gears of the shift table that are gears; rows such as N are left out."""
    return dict(_states(box))


@lru_cache(maxsize=256)
def _states(box: Definition) -> Mapping[str, GearState]:
    found = {gear: state(box, box.closed_in(gear), gear) for gear in box.gears}
    return {gear: one for gear, one in found.items() if one is not None}


def swaps(box: Definition) -> Iterator[Swap]:
    """Every shift from one gear to another, in the order of the table."""
    ratios = {gear: combination(box, box.closed_in(gear)) for gear in box.gears}
    gears = {gear: found.ratio for gear, found in ratios.items() if found.ratio}
    for before, after in permutations(gears, 2):
        first, second = box.gears[before], box.gears[after]
        opens = tuple(name for name in first if name not in second)
        closes = tuple(name for name in second if name not in first)
        yield Swap(before, after, opens, closes, float(gears[before] / gears[after]))


def capacities(box: Definition) -> dict[str, Capacity]:
    """What each element must hold, and how fast it slips while open."""
    found = states(box)
    made = {}
    for element in box.elements:
        name = element.name
        held = {gear: _most(box, one, name) for gear, one in found.items() if name in one.torques}
        slips = {gear: abs(one.slips[name]) for gear, one in found.items() if name in one.slips}
        most, fastest = (max(values, key=values.__getitem__, default="") for values in (held, slips))
        made[name] = Capacity(
            name,
            held.get(most, 0.0),
            most,
            tuple(gear for gear, one in found.items() if name in one.closed),
            slips.get(fastest, 0.0),
            fastest,
        )
    return made


def _most(box: Definition, one: GearState, name: str) -> float:
    """Torque of a closed element; where it shares it, the largest with others of those that share open."""
    if not isnan(one.torques[name]):
        return abs(one.torques[name])
    others = [other for other, torque in one.torques.items() if isnan(torque) and other != name]
    for size in range(1, len(others) + 1):
        left = (tuple(n for n in one.closed if n not in some) for some in combinations(others, size))
        alone = [made.torques[name] for closed in left if (made := state(box, closed)) is not None]
        known = [abs(torque) for torque in alone if not isnan(torque)]
        if known:
            return max(known)
    return 0.0
