"""Why a parameter is not determined, in words."""

from __future__ import annotations

from math import exp, log
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.fit.information import FLOOR, Information
from clutchwork.fit.words import plain

if TYPE_CHECKING:
    from clutchwork.fit.unknown import Unknown

Items = tuple["Unknown", ...]

# part of a parameter in a direction that counts as involved
INVOLVED = 0.05
# an interval wider than this says nothing: a factor either way, or a share of the value
WIDE_FACTOR, WIDE_SHARE = 2.0, 0.5


def causes(known: Information, spread: Array, items: Items) -> list[str]:
    """Reasons in the structure of the derivatives, whatever the noise; "" where there is none.

    Parameters: spread, derivatives of the codes of all parameters by those that are searched for.
    """
    made = [""] * len(items)
    for direction in known.directions[known.lost]:
        part = np.abs(_relative(spread @ (direction / known.size), items))
        involved = part > INVOLVED * float(np.max(part))
        names = [item.name for item, is_in in zip(items, involved, strict=True) if is_in]
        for place in np.flatnonzero(involved) if len(names) > 1 else ():
            made[place] = f"the samples determine only a combination of {', '.join(names)}"
    for place in np.flatnonzero(known.silent):
        moved = np.abs(spread[:, place])
        for row in np.flatnonzero(moved > 0.5 * np.max(moved)):
            made[row] = "no sample depends on it"
    return made


def at_end(item: Unknown, value: float, ends: tuple[float, float]) -> str:
    """Whether a parameter went as far as it could."""
    reach = 1e-6 * max(abs(item.start), abs(value))
    if item.over and value - ends[0] <= reach:
        return "it lies on its bound, the kinetic coefficient"
    if any(abs(value - end) <= reach for end in ends):
        return f"it lies on its bound {item.bound}"
    return f"it diverged to {value:.3g}" if any(abs(value - end) <= reach for end in (item.lower, item.upper)) else ""


def wide(item: Unknown, code: float, half: float, confidence: float, size: float = 0.0) -> str:
    """Whether an interval of the code, plus and minus half, is too wide to say anything.

    Parameters: size, what a number that may be zero is compared with, where that is more than itself.
    """
    share = f"{100 * confidence:g} % interval"
    if item.is_log:
        factor = exp(min(half, log(1e9)))
        shown = "many orders of magnitude" if factor > 1e6 else f"a factor {plain(factor, 3)}"
        return f"its {share} reaches {shown} either way" if factor > WIDE_FACTOR else ""
    if half <= WIDE_SHARE * max(abs(code), size):
        return ""
    if abs(code) < half:
        return f"it cannot be distinguished from zero, its {share} is +- {plain(half, 3)}"
    return f"its {share} is +- {100 * half / abs(code):.3g} %"


def spans(item: Unknown, limits: tuple[float, float]) -> bool:
    """Whether limits of a value are too far apart to say anything."""
    low, high = limits
    if item.is_log:
        return high > WIDE_FACTOR**2 * low
    return high - low > WIDE_SHARE * abs(high + low)


def directions(known: Information, spread: Array, items: Items, codes: Array, reasons: list[str]) -> list[str]:
    """For every open parameter what changes with it along the direction in which its uncertainty is largest."""
    # share of each direction in the uncertainty of each parameter
    shares = np.abs(spread @ (known.directions / known.size).T) / np.maximum(known.singular, FLOOR)
    made = []
    for place, reason in enumerate(reasons):
        change = spread @ (known.directions[int(np.argmax(shares[place]))] / known.size)
        made.append(_direction(_relative(change, items), place, items, codes) if reason else "")
    return made


def _relative(change: Array, items: Items) -> Array:
    """Changes of codes as shares of the start values."""
    return np.asarray(change / np.array([item.scale for item in items]))


def _direction(change: Array, place: int, items: Items, codes: Array) -> str:
    """By how much the values of others change when this one grows by 1 %; empty where it is alone."""
    involved = np.abs(change) > INVOLVED * (np.abs(change[place]) or 1.0)
    grown = np.array([1.0 if i.is_log else max(1.0, abs(c) / i.scale) for i, c in zip(items, codes, strict=True)])
    shares = change / grown
    moved = zip(items, (shares / (shares[place] or 1.0)).tolist(), involved.tolist(), strict=True)
    shown = [f"{item.name} {plain(share, sign='+')} %" for item, share, is_in in moved if is_in]
    return ", ".join(shown) if len(shown) > 1 else ""
