"""One exchange of elements, by the torques of the gears before and after it. docs/theory/shifts.md (1) to (4)."""

from __future__ import annotations

from itertools import pairwise, product
from typing import TYPE_CHECKING

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import UseError
from clutchwork.base.shown import listed
from clutchwork.gearbox.motion import speeds

if TYPE_CHECKING:
    from collections.abc import Mapping

    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.gearbox.state import GearState


@dataclass(frozen=True)
class Exchange:
    """An element that opens and one that closes, while others stay closed.

    `off` is empty where a gear is engaged from neutral, `on` where one is left. `off_torque` and `on_torque` are what
    they carry per torque 1 of the input in the gear before and after, `before` and `after` the ratios of these.
    """

    off: str
    on: str
    kept: tuple[str, ...]
    off_torque: float
    on_torque: float
    before: float  # 0: there is none
    after: float
    inertia: float  # kg m2, of all members at the input with the output at rest, both elements open


def exchanges(
    box: Gearbox, before: tuple[str, ...], after: tuple[str, ...], inertias: Mapping[str, float]
) -> tuple[Exchange, ...]:
    """What a shift takes: one exchange, or several in a row where more than one element changes.

    Parameters: before and after, closed elements; inertias, of members [kg m2]. The way goes through gears, from which
    the next exchange starts; of several ways the one whose ratios stay closest to those of both gears is taken.
    UseError where there is none.
    """
    opens = [name for name in before if name not in after]
    closes = [name for name in after if name not in before]
    if not opens and not closes:
        return ()
    if not box.combination(before).ratio or not opens:
        return _engage(box, after, closes, inertias)
    ways = list(_ways(box, tuple(before), tuple(opens), tuple(closes)))
    if not ways:
        fault = f"there is no way of single exchanges from {listed(before)} to {listed(after)} through gears"
        raise UseError("shift", [f"{fault}; shift through another gear"])
    way = min(ways, key=lambda one: _detour(box, before, one))
    made, closed = [], tuple(before)
    for off, on in way:
        later = tuple(name for name in closed if name != off) + ((on,) if on else ())
        made.append(_exchange(box, off, on, closed, later, inertias))
        closed = later
    return tuple(made)


def _ways(
    box: Gearbox, closed: tuple[str, ...], opens: tuple[str, ...], closes: tuple[str, ...]
) -> list[tuple[tuple[str, str], ...]]:
    """Sequences of pairs, each of which leaves a gear."""
    if not opens and not closes:
        return [()]
    found = []
    for off, on in product(opens or ("",), closes or ("",)):
        later = tuple(name for name in closed if name != off) + ((on,) if on else ())
        if box.combination(later).ratio is None:
            continue
        rest = tuple(name for name in opens if name != off), tuple(name for name in closes if name != on)
        found += [((off, on), *more) for more in _ways(box, later, *rest)]
    return found


def _detour(box: Gearbox, before: tuple[str, ...], way: tuple[tuple[str, str], ...]) -> float:
    """How far the ratios of a way go beyond its ends, as the sum of steps."""
    closed, ratios = before, [_ratio(box, before)]
    for off, on in way:
        closed = tuple(name for name in closed if name != off) + ((on,) if on else ())
        ratios.append(_ratio(box, closed))
    speeds = [1.0 / ratio for ratio in ratios]
    return sum(abs(second - first) for first, second in pairwise(speeds))


def _ratio(box: Gearbox, closed: tuple[str, ...]) -> float:
    return float(box.combination(closed).ratio or 0.0)


def _engage(
    box: Gearbox,
    after: tuple[str, ...],
    closes: list[str],
    inertias: Mapping[str, float],
) -> tuple[Exchange, ...]:
    """From neutral into a gear by the element that turns fastest against what it joins; or out of one."""
    if not box.combination(after).ratio:
        return ()
    state = box.state(after)
    # a brake or clutch whose torque is the least makes the softest engagement
    usable = [name for name in closes if box.element(name).kind in ("clutch", "brake")]
    if not usable:
        raise UseError("shift", [f"{listed(closes)} cannot slip; close a clutch or a brake to engage a gear"])
    on = min(usable, key=lambda name: abs(state.torques[name]))
    kept = tuple(name for name in after if name != on)
    return (Exchange("", on, kept, 0.0, state.torques[on], 0.0, state.ratio, _inertia(box, kept, inertias)),)


def _exchange(
    box: Gearbox, off: str, on: str, before: tuple[str, ...], after: tuple[str, ...], inertias: Mapping[str, float]
) -> Exchange:
    old, new = box.state(before), box.state(after)
    kept = tuple(name for name in before if name != off)
    torque = _torque(new, on) if on else 0.0
    inertia = _inertia(box, kept, inertias)
    return Exchange(off, on, kept, _torque(old, off) if off else 0.0, torque, old.ratio, new.ratio, inertia)


def _torque(state: GearState, name: str) -> float:
    value = state.torques[name]
    return 0.0 if value != value else value


def _inertia(box: Gearbox, kept: tuple[str, ...], inertias: Mapping[str, float]) -> float:
    """Inertia of all members at the input while the output stands and one motion more is free: equation (3)."""
    rows = speeds(box, kept)
    upper, lower = rows[box.input], rows[box.output]
    columns = sorted({*upper, *lower})
    if len(columns) != 2:
        return 0.0
    a, b = columns
    # weights of the two free motions that leave the output at rest and turn the input with 1
    x, y = -lower.get(b, 0), lower.get(a, 0)
    size = upper.get(a, 0) * x + upper.get(b, 0) * y
    if not size:
        return 0.0
    turning = {name: float((row.get(a, 0) * x + row.get(b, 0) * y) / size) for name, row in rows.items()}
    return sum(inertia * turning.get(name, 0.0) ** 2 for name, inertia in inertias.items())
