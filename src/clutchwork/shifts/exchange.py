"""One exchange of elements, by the torques of the gears before and after it. docs/theory/shifts.md (1) to (4)."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from itertools import pairwise, product

from clutchwork.base import UseError, dataclass, listed
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.gearbox.motion import speeds
from clutchwork.gearbox.state import GearState

# kinds that slip with a torque, and those that engage by teeth
FRICTION, SLEEVES = ("clutch", "brake"), ("dog", "synchroniser")


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

    @property
    def idle(self) -> bool:
        """Whether both gears are one: what opens and what closes carries nothing, and no speed waits for it."""
        return bool(self.off) and self.before == self.after


def exchanges(
    box: Gearbox, before: tuple[str, ...], after: tuple[str, ...], inertias: Mapping[str, float]
) -> tuple[Exchange, ...]:
    """What a shift takes: one exchange, or several in a row where more than one element changes.

    Parameters: before and after, closed elements; inertias, of members [kg m2]. The way goes through gears, from which
    the next exchange starts; of several ways the one whose ratios stay closest to those of both gears is taken. Where
    there is none, and between forward and reverse, all that opens does so at once, and one element engages the gear.
    None where the new elements make no gear.
    """
    opens = tuple(name for name in before if name not in after)
    closes = tuple(name for name in after if name not in before)
    old, new = ratio_of(box, before), ratio_of(box, after)
    if not new or not opens + closes:
        return ()
    ways = _ways(box, before, opens, closes) if old * new > 0.0 else []
    if not ways:
        return (_engage(box, after, closes, inertias),)
    way = min(ways, key=lambda one: _detour(box, before, one))
    made, closed = [], before
    for off, on in way:
        later = _swapped(closed, off, on)
        made.append(exchange(box, off, on, closed, later, inertias))
        closed = later
    return tuple(made)


def _swapped(closed: tuple[str, ...], off: str, on: str) -> tuple[str, ...]:
    return tuple(name for name in closed if name != off) + ((on,) if on else ())


@lru_cache(maxsize=4096)
def state_of(box: Gearbox, closed: tuple[str, ...]) -> GearState:
    """Of closed elements that make a gear."""
    return box.state(closed)


@lru_cache(maxsize=4096)
def ratio_of(box: Gearbox, closed: tuple[str, ...]) -> float:
    """Of a combination, 0 where it has none."""
    return float(box.combination(closed).ratio or 0.0)


def _ways(
    box: Gearbox, closed: tuple[str, ...], opens: tuple[str, ...], closes: tuple[str, ...]
) -> list[tuple[tuple[str, str], ...]]:
    """Sequences of pairs, each of which leaves a gear."""
    if not opens and not closes:
        return [()]
    found = []
    for off, on in product(opens or ("",), closes or ("",)):
        later = _swapped(closed, off, on)
        if not ratio_of(box, later):
            continue
        rest = tuple(name for name in opens if name != off), tuple(name for name in closes if name != on)
        found += [((off, on), *more) for more in _ways(box, later, *rest)]
    return found


def _detour(box: Gearbox, before: tuple[str, ...], way: tuple[tuple[str, str], ...]) -> float:
    """How far the ratios of a way go beyond its ends: equation (4)."""
    closed, ratios = before, [ratio_of(box, before)]
    for off, on in way:
        closed = _swapped(closed, off, on)
        ratios.append(ratio_of(box, closed))
    return sum(abs(second - first) for first, second in pairwise(ratios))


def _engage(box: Gearbox, after: tuple[str, ...], closes: tuple[str, ...], inertias: Mapping[str, float]) -> Exchange:
    """Into a gear by one element that slips, the softest: a clutch or brake that carries the least, but something."""
    state = state_of(box, after)
    usable = _usable(box, after, closes) or _usable(box, after, after)
    if not usable:
        raise UseError("shift", [f"{listed(after)} cannot slip; close a clutch or a brake to engage a gear"])
    on = min(usable, key=lambda name: abs(_torque(state, name)))
    kept = tuple(name for name in after if name != on)
    return Exchange("", on, kept, 0.0, _torque(state, on), 0.0, state.ratio, _inertia(box, kept, inertias))


def _usable(box: Gearbox, after: tuple[str, ...], names: tuple[str, ...]) -> list[str]:
    """Clutches and brakes without which the gear is none."""
    slide = [name for name in names if box.element(name).kind in FRICTION]
    return [name for name in slide if not ratio_of(box, tuple(one for one in after if one != name))]


def exchange(
    box: Gearbox, off: str, on: str, before: tuple[str, ...], after: tuple[str, ...], inertias: Mapping[str, float]
) -> Exchange:
    """Of one element by another; before and after, all that is closed then."""
    old, new = state_of(box, before), state_of(box, after)
    kept = tuple(name for name in before if name != off)
    torque = _torque(new, on) if on else 0.0
    inertia = _inertia(box, kept, inertias)
    return Exchange(off, on, kept, _torque(old, off) if off else 0.0, torque, old.ratio, new.ratio, inertia)


def _torque(state: GearState, name: str) -> float:
    """0 where several elements share one in more than one way."""
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
