"""Contacts that act against each other."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.assembly.wiring import wiring
from clutchwork.hints.hint import Hint, shown, together
from clutchwork.hints.registry import run_rule
from clutchwork.results.ratios import gears, input_and_output

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from clutchwork.assembly.system import System
    from clutchwork.hints.look import Look, RowSpan

    Shifts = Callable[[], frozenset[str]]
    Pair = tuple[int, int]
    Rows = NDArray[np.bool_]

NAME = "tie-up"
# share of the heat of all contacts below which the overlap is what every shift needs
SHARE = 0.1
# more actuated contacts than any gearbox has make too many pairs
MOST = 24


@run_rule(NAME)
def tie_up(look: Look) -> Iterator[Hint]:
    """Two contacts that together would hold their shafts still, each with a torque that the other has to overcome."""
    total = float(np.sum(look.heat[-1] - look.heat[0])) if look.contacts else 0.0
    actuated = [contact for contact in range(len(look.contacts)) if look.actuated(contact)]
    if total <= 0.0 or len(actuated) > MOST:
        return
    sets, number = np.unique(look.locked, axis=0, return_inverse=True)
    phases = [(tuple(np.flatnonzero(locked).tolist()), number.ravel() == k) for k, locked in enumerate(sets)]
    shifts: Shifts = cache(lambda: _in_gears(look.system))
    for pair in combinations(actuated, 2):
        lost = np.zeros(len(look.time))
        for locked, rows in phases:
            lost += _lost(look, pair, locked, rows, shifts)
        steps = 0.5 * (lost[1:] + lost[:-1]) * np.diff(look.time)
        spans = look.spans(lost > 0.0)
        if spans and sum(float(np.sum(steps[span.first : span.last])) for span in spans) >= SHARE * total:
            yield _hint(look, pair, spans, total)


def _lost(look: Look, pair: Pair, locked: tuple[int, ...], rows: Rows, shifts: Shifts) -> NDArray[np.float64]:
    """Power that the smaller torque of a pair costs against the other [W] in the rows with one set of locked contacts.

    Torques and slips are measured by the inertia that they move. Zero where the two do not oppose each other.
    """
    none = np.zeros(len(look.time))
    rows = rows & np.all(look.closed[:, pair], axis=1)
    others = tuple(k for k in locked if k not in pair)
    if not np.any(rows) or set(pair) <= set(locked):
        return none
    ease = look.motion.eases(others)
    torque, slip = np.abs(look.part("contact_torque")[:, pair]), np.abs(look.slip[:, pair])
    # each torque drives the slip of the other on
    rows = rows & (ease[pair] * np.prod(look.part("contact_torque")[:, pair], axis=1) < 0.0)
    if not np.any(rows) or (others != locked and not shifts() >= _names(look, pair)):
        return none
    closed = frozenset(look.contacts[k].name for k in (*others, *pair))
    if not all(look.motion.stalls(k, closed) for k in pair):
        return none
    moves = np.sqrt(np.diag(ease)[list(pair)])
    power = np.min(torque * moves, axis=1) * np.sum(slip / moves, axis=1)
    return np.where(rows, power, 0.0)


def _in_gears(system: System) -> frozenset[str]:
    """Contacts that take part in a gear: a brake of the wheels does not, whose work is to slip."""
    shafts = input_and_output(wiring(system))
    found = gears(system, shafts).ratios if shafts else ()
    return frozenset(name for closed, _ in found for name in closed)


def _names(look: Look, pair: Pair) -> frozenset[str]:
    return frozenset(look.contacts[k].name for k in pair)


def _hint(look: Look, pair: Pair, spans: list[RowSpan], total: float) -> Hint:
    begin, end = float(look.time[spans[0].first]), float(look.time[spans[-1].last])
    length = sum(float(look.time[span.last] - look.time[span.first]) for span in spans)
    heat = sum(float(np.sum(look.heat[span.last, pair] - look.heat[span.first, pair])) for span in spans)
    names = tuple(look.contacts[k].name for k in pair)
    message = (
        f"act against each other from {begin:.4g} to {end:.4g} s: locked together they would hold their shafts still;"
        f" they burn {shown(heat, 'J')} there, {shown(heat / length, 'W')} on average and {heat / total:.0%} of the"
        " heat of all contacts"
    )
    remedy = f"let one open before the other closes: less overlap of {together(names)}"
    numbers = {"heat [J]": heat, "power [W]": heat / length, "share [1]": heat / total, "overlap [s]": length}
    return Hint(NAME, names, message, remedy, numbers, begin, end)
