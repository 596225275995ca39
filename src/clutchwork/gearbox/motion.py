"""Speeds that gears and closed elements leave free, and which torques keep them in balance. Exact fractions."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

from clutchwork.base import dataclass
from clutchwork.declare.rational import ONE, Echelon, Row, eliminate

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition

GEAR, NEUTRAL, TIE_UP, SPLIT = "gear", "neutral", "tie-up", "split"
INPUT_HELD, OUTPUT_HELD = "input held", "output held"


@dataclass(frozen=True)
class Combination:
    """What a gearbox does with some of its elements closed.

    `kind`: "gear", where input and output keep one ratio and both turn; "input held" and "output held", where one
    cannot turn and the other can; "tie-up", where neither can; "neutral", where both are free of each other; "split",
    where they are so except for a machine that turns with both, two speeds are free, and power goes two ways.
    """

    closed: tuple[str, ...]
    kind: str
    dof: int  # speeds that are left free
    redundant: int  # closed elements that hold what others hold already
    ratio: Fraction | None  # speed of the input over that of the output, of a gear alone
    gear: str = ""  # its name in the shift table

    @property
    def idle(self) -> bool:
        """Whether members turn freely beside the way from input to output."""
        return self.kind == GEAR and self.dof > 1


def solved(box: Definition, closed: Collection[str]) -> Echelon:
    """Rows of gears and closed elements, solved for members in an order that leaves input and output to the end."""
    places = {member: place for place, member in enumerate(box.members)}
    rows = [row for one in box.sets for row in one.rows()]
    rows += [element.row() for element in box.elements if element.name in closed]
    order = [*list(places.values())[2:], places[box.output], places[box.input]]
    return eliminate((_by_place(row, places) for row in rows), order, traced=False)


def _by_place(row: dict[str, Fraction], places: dict[str, int]) -> Row:
    return {places[member]: value for member, value in row.items() if value}


def speeds(box: Definition, closed: Collection[str]) -> dict[str, Row]:
    """Speed of each member as a linear combination of the speeds of the free members."""
    echelon = solved(box, closed)
    found = dict[str, Row]()
    for place, member in enumerate(box.members):
        row = echelon.solved.get(place)
        found[member] = {place: ONE} if row is None else {n: -v for n, v in row.items() if n != place}
    return found


def combination(box: Definition, closed: Collection[str]) -> Combination:
    """Classify one set of closed elements."""
    names = tuple(element.name for element in box.elements if element.name in closed)
    echelon = solved(box, names)
    dof, redundant = len(box.members) - len(echelon.solved), len(echelon.spare)
    # the input and the output are solved for last, so one of them follows from the other alone or is free
    moved = [_free(echelon, place) for place in (0, 1)]
    kind, ratio = _kind(*moved)
    if kind == NEUTRAL and dof == 2 and _splits(box, echelon):
        kind = SPLIT
    wanted = {frozenset(box.closed_in(gear)): gear for gear in reversed(list(box.gears))}
    return Combination(names, kind, dof, redundant, ratio, wanted.get(frozenset(names), ""))


def _free(echelon: Echelon, place: int) -> Row:
    row = echelon.solved.get(place)
    return {place: ONE} if row is None else {n: -v for n, v in row.items() if n != place}


def _splits(box: Definition, echelon: Echelon) -> bool:
    """Whether the torque of a machine holds that of the input and that of the output at once."""
    places = {member: place for place, member in enumerate(box.members)}
    turning = (_free(echelon, places[member]) for member in box.machines.values() if member in places)
    return any({0, 1} <= row.keys() for row in turning)


def _kind(upper: Row, lower: Row) -> tuple[str, Fraction | None]:
    if not upper or not lower:
        return (TIE_UP if not upper and not lower else OUTPUT_HELD if upper else INPUT_HELD), None
    column = next(iter(lower))
    ratio = upper.get(column, Fraction(0)) / lower[column]
    same = ratio and upper == {n: ratio * v for n, v in lower.items()}
    return (GEAR, ratio) if same else (NEUTRAL, None)


def all_combinations(box: Definition) -> Iterator[Combination]:
    """Every set of closed elements that holds those which always are, small ones first."""
    names = [element.name for element in box.elements if element.name not in box.always_closed]
    for size in range(len(names) + 1):
        for some in combinations(names, size):
            yield combination(box, {*some, *box.always_closed})
