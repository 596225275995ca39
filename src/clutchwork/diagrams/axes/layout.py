"""Which members share an axis, where axes and wheels stand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from clutchwork.base import dataclass
from clutchwork.gearbox.gear_set import HOUSING

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition

# px: between axes, between columns, of the first wheel, between lines of one axis
APART, COLUMN, FIRST, NESTED = 84.0, 46.0, 120.0, 7.0
# px: half of the smallest and the largest wheel
SMALL, LARGE = 9.0, 32.0


@dataclass(frozen=True)
class Axes:
    """Places of a drawing of parallel axes [px].

    Parameters: heights, of the line of each member; columns, of each gear pair; symbols, of each shift element; halves,
    half of the first and the second wheel of each pair; loose, members that turn on the shaft of another.
    """

    heights: Mapping[str, float]
    columns: Mapping[str, float]
    symbols: Mapping[str, float]
    halves: Mapping[str, tuple[float, float]]
    loose: frozenset[str]
    right: float


def fits(box: Definition) -> bool:
    """Whether a gearbox is of gear pairs alone, so that it has parallel axes."""
    return all(not one.shape.carried for one in box.sets)


def axes(box: Definition) -> Axes:
    """Where everything stands."""
    groups = _groups(box)
    first = next(group for group in groups if box.input in group)
    others = [group for group in groups if group is not first]
    # the output last, axes in turn above and below the input
    others.sort(key=lambda group: box.output in group)
    heights, steps = dict[str, float](), [0, *(n // 2 * (1 if n % 2 else -1) for n in range(2, len(others) + 2))]
    for step, group in zip(steps, [first, *others], strict=True):
        heights.update(dict.fromkeys(group, APART * step))
    loose = frozenset(
        one.second for one in box.elements if one.kind in ("synchroniser", "dog") and HOUSING not in one.members
    )
    shafts = [member for member in first if member != box.input and member not in loose]
    # the hollow shaft is the shorter one, nearer to the clutches
    for number, member in enumerate(shafts):
        heights[member] += NESTED * (number - (len(shafts) - 1) / 2)
    order = sorted(box.sets, key=lambda one: _rank(box, one.members["first"], shafts))
    columns = {one.name: FIRST + COLUMN * number for number, one in enumerate(order)}
    symbols = dict[str, float]()
    clutches = [one for one in box.elements if box.input in one.members]
    for number, element in enumerate(clutches):
        symbols[element.name] = 40.0 + 34.0 * number
    for element in box.elements:
        if element.name not in symbols:
            symbols[element.name] = _beside(box, element.second, columns)
    halves = {one.name: _halves(one.speeds_of_planets()) for one in box.sets}
    return Axes(heights, columns, symbols, halves, loose, max(columns.values()) + COLUMN)


def _rank(box: Definition, member: str, shafts: list[str]) -> tuple[int, int]:
    """Pairs on the hollow shaft, on the other one, then those behind them, the axle last."""
    place = len(shafts) - shafts.index(member) if member in shafts else len(shafts) + 1
    return (1 if _drives(box, member) else 0, place)


def _drives(box: Definition, member: str) -> bool:
    return any(one.members["first"] == member and one.members["second"] == box.output for one in box.sets)


def _beside(box: Definition, member: str, columns: Mapping[str, float]) -> float:
    """Right of the wheel that an element engages."""
    own = [columns[one.name] for one in box.sets if member in one.members.values()]
    return (own[-1] if own else FIRST) + 0.45 * COLUMN


def _halves(sizes: tuple[object, ...]) -> tuple[float, float]:
    first, second = (abs(float(size)) for size in sizes)  # type: ignore[arg-type]
    total = LARGE + SMALL
    return (
        min(LARGE, max(SMALL, total * first / (first + second))),
        min(LARGE, max(SMALL, total * second / (first + second))),
    )


def _groups(box: Definition) -> list[list[str]]:
    """Members that elements join stand on one axis."""
    of = {member: [member] for member in box.members}
    for element in box.elements:
        if HOUSING in element.members or of[element.first] is of[element.second]:
            continue
        joined = [*of[element.first], *of[element.second]]
        for member in joined:
            of[member] = joined
    made = list[list[str]]()
    for group in of.values():
        if not any(group is other for other in made):
            made.append(group)
    return made
