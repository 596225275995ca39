"""Contacts that act against each other."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.assembly.wiring import wiring
from clutchwork.results.hints.hint import Hint, shown, together
from clutchwork.results.hints.registry import run_rule
from clutchwork.results.ratios import gears, input_and_output

if TYPE_CHECKING:
    from collections.abc import Callable

    from clutchwork.assembly.system import System
    from clutchwork.results.hints.look import Look, Span

    Shifts = Callable[[], frozenset[str]]

NAME = "tie-up"
# share of the heat of all contacts below which the overlap is what every shift needs
SHARE = 0.1


@run_rule(NAME)
def tie_up(look: Look) -> Iterator[Hint]:
    """Two contacts that together would hold their shafts still, each with a torque that the other has to overcome."""
    total = float(np.sum(look.heat[-1] - look.heat[0])) if look.contacts else 0.0
    if total <= 0.0:
        return
    shifts: Shifts = cache(lambda: _in_gears(look.system))
    actuated = [contact for contact in range(len(look.contacts)) if look.actuated(contact)]
    for pair in combinations(actuated, 2):
        lost = _lost(look, pair, shifts)
        if np.any(lost):
            steps = 0.5 * (lost[1:] + lost[:-1]) * np.diff(look.time)
            spans = look.spans(lost > 0.0)
            against = sum(float(np.sum(steps[span.first : span.last])) for span in spans)
            if spans and against >= SHARE * total:
                yield _hint(look, pair, spans, total)


def _lost(look: Look, pair: tuple[int, int], shifts: Shifts) -> np.ndarray:
    """Power that the smaller torque of a pair costs against the other [W], zero where they do not oppose each other."""
    both = np.all(look.closed[:, pair], axis=1) & ~np.all(look.locked[:, pair], axis=1)
    lost = np.zeros(len(look.time))
    for row in np.flatnonzero(both).tolist():
        if _oppose(look, row, pair) and (not np.any(look.locked[row, pair]) or shifts() >= _names(look, pair)):
            lost[row] = _power(look, row, pair)
    return lost


def _oppose(look: Look, row: int, pair: tuple[int, int]) -> bool:
    """Whether each torque drives the slip of the other on, and the shafts of both would stand if both locked."""
    others = tuple(k for k in np.flatnonzero(look.locked[row]).tolist() if k not in pair)
    one, other = look.part("contact_torque")[row, pair]
    if not look.motion.eases(others)[pair] * one * other < 0.0:
        return False
    closed = frozenset(look.contacts[k].name for k in (*others, *pair))
    return all(look.motion.stalls(k, closed) for k in pair)


def _power(look: Look, row: int, pair: tuple[int, int]) -> float:
    """The smaller torque times both slips, each measured by the inertia that it moves."""
    others = tuple(k for k in np.flatnonzero(look.locked[row]).tolist() if k not in pair)
    ease = np.sqrt(np.diag(look.motion.eases(others))[list(pair)])
    torque, slip = np.abs(look.part("contact_torque")[row, pair]), np.abs(look.slip[row, pair])
    return float(np.min(torque * ease) * np.sum(slip / ease))


def _in_gears(system: System) -> frozenset[str]:
    """Contacts that take part in a gear: a brake of the wheels does not, whose work is to slip."""
    shafts = input_and_output(wiring(system))
    found = gears(system, shafts).ratios if shafts else ()
    return frozenset(name for closed, _ in found for name in closed)


def _names(look: Look, pair: tuple[int, int]) -> frozenset[str]:
    return frozenset(look.contacts[k].name for k in pair)


def _hint(look: Look, pair: tuple[int, int], spans: list[Span], total: float) -> Hint:
    begin, end = float(look.time[spans[0].first]), float(look.time[spans[-1].last])
    length = sum(float(look.time[span.last] - look.time[span.first]) for span in spans)
    heat = sum(float(np.sum(look.heat[span.last, pair] - look.heat[span.first, pair])) for span in spans)
    names = tuple(look.contacts[k].name for k in pair)
    message = (
        f"act against each other from {begin:.4g} to {end:.4g} s: locked together they would hold their shafts still;"
        f" they burn {shown(heat, 'J')} there, {shown(heat / length, 'W')} on average and {heat / total:.0%} of the heat"
        " of all contacts"
    )
    remedy = f"let one open before the other closes: less overlap of {together(names)}"
    numbers = {"heat [J]": heat, "power [W]": heat / length, "share [1]": heat / total, "overlap [s]": length}
    return Hint(NAME, names, message, remedy, numbers, begin, end)
