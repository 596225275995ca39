"""Contacts that act against each other."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.results.hints.hint import Hint, shown, together
from clutchwork.results.hints.registry import run_rule

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from clutchwork.results.hints.look import Look, Span

NAME = "tie-up"
# share of the heat of all contacts below which an overlap is what every shift needs
SHARE = 0.05


@run_rule(NAME)
def tie_up(look: Look) -> Iterator[Hint]:
    """Two contacts that slip and together would hold their shafts, so that each makes the other slip faster."""
    slipping = look.closed & ~look.locked
    total = float(np.sum(look.heat[-1] - look.heat[0])) if look.contacts else 0.0
    if total <= 0.0:
        return
    for one, other in combinations(range(len(look.contacts)), 2):
        both = np.flatnonzero(slipping[:, one] & slipping[:, other])
        if both.size < 2:
            continue
        chosen = np.zeros(len(look.time), dtype=bool)
        chosen[both] = [_against(look, int(row), one, other) for row in both]
        found = [(span, _burnt(look, span, (one, other))) for span in look.spans(chosen)]
        heat = sum(burnt for _, burnt in found)
        if heat >= SHARE * total:
            yield _hint(look, (one, other), [span for span, _ in found], heat, total)


def _against(look: Look, row: int, one: int, other: int) -> bool:
    """Whether the torque of each raises the slip of the other, and their shafts would stand if both locked."""
    locked = tuple(np.flatnonzero(look.locked[row]).tolist())
    torque: NDArray[np.float64] = look.part("contact_torque")[row]
    if look.motion.eases(locked)[one, other] * torque[one] * torque[other] >= 0.0:
        return False
    closed = frozenset(look.contacts[k].name for k in (*locked, one, other))
    return look.motion.stalls(one, closed) and look.motion.stalls(other, closed)


def _burnt(look: Look, span: Span, pair: tuple[int, int]) -> float:
    return float(np.sum(look.heat[span.last, pair] - look.heat[span.first, pair]))


def _hint(look: Look, pair: tuple[int, int], spans: list[Span], heat: float, total: float) -> Hint:
    begin, end = float(look.time[spans[0].first]), float(look.time[spans[-1].last])
    length = sum(float(look.time[span.last] - look.time[span.first]) for span in spans)
    names = tuple(look.contacts[k].name for k in pair)
    message = (
        f"act against each other from {begin:.4g} to {end:.4g} s: both slip, and locked together they would hold their"
        f" shafts still; they burn {shown(heat, 'J')}, {heat / length:.4g} W on average, {heat / total:.0%} of the heat"
        " of all contacts"
    )
    remedy = f"let one open before the other closes: less overlap of {together(names)}"
    numbers = {"heat [J]": heat, "power [W]": heat / length, "share [1]": heat / total, "overlap [s]": length}
    return Hint(NAME, names, message, remedy, numbers, begin, end)
