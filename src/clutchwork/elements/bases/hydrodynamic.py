"""What elements with tables over a ratio of speeds have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from clutchwork.base.quote import apart
from clutchwork.declare import Found


def one_of(element: Any, *names: str) -> Found:
    """That exactly one of several fields is given."""
    given = [name for name in names if getattr(element, name) is not None]
    if len(given) == 1:
        return []
    words = " or ".join(names)
    fault = "is missing" if not given else f"is given beside {given[0]}"
    return [(given[-1] if given else names[0], fault, f"give {words}, one of them")]


def ratio_problems(ratios: Sequence[float], least: float) -> Found:
    """Ratios that do not end at 1, or start too low."""
    if len(ratios) < 2:
        return [("speed_ratio", f"has {len(ratios)} points, must have at least 2", "give the ratios from stall to 1")]
    if ratios[0] < least:
        fault = f"starts at {apart(ratios[0], least)}, below {least:g}"
        return [("speed_ratio", fault, f"start at {least:g} or above")]
    if ratios[-1] != 1.0:
        fault = f"ends at {apart(ratios[-1], 1.0)}, must end at 1"
        return [("speed_ratio", fault, "add the point 1, where no torque is left")]
    return []


def at_each_ratio(name: str, values: Sequence[float], ratios: Sequence[float]) -> Found:
    """That there is a value for each ratio."""
    if len(values) == len(ratios):
        return []
    return [(name, f"has {len(values)} values for {len(ratios)} speed ratios", "give one for each speed ratio")]


def falls_to_zero(name: str, values: Sequence[float]) -> Found:
    """That nothing is transmitted at equal speeds, where the torque changes its direction."""
    if values[-1] == 0.0:
        return []
    return [(name, f"is {values[-1]:g} at speed ratio 1, must be 0: the torque would jump there", "let it end with 0")]
