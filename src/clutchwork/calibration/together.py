"""Numbers that one unknown moves together: all of a lining by one factor, all knots of a pressure by one delay."""

from __future__ import annotations

from collections.abc import Sequence

from clutchwork.base import UseError, dataclass, quote
from clutchwork.declare.calls import explained
from clutchwork.sweeps.numbers import pair

FACTOR, SHIFT, VALUE = "factor", "shift", "value"


@dataclass(frozen=True)
class Together:
    """Numbers by name that are multiplied by one factor, or shifted by one amount, from `low` to `high`."""

    names: tuple[str, ...]
    kind: str  # "factor" or "shift"
    low: float
    high: float


@explained("cw.together", names="['F1.gain', 'F2.gain']")
def together(
    names: Sequence[str] | str, *, factor: tuple[float, float] | None = None, shift: tuple[float, float] | None = None
) -> Together:
    """Several numbers of a driveline as one unknown of `cw.calibrate`, or as one scatter of production.

    Parameters: names, as `cw.gradient` takes them, "F1.pressure.times" for all knots of a table; factor, (low, high)
    by which all of them are multiplied [1]; shift, (low, high) that is added to all, in their unit.

        cw.together(["F1.friction.static", "F1.friction.kinetic"], factor=(0.9, 1.1))
        cw.together("F1.pressure.times", shift=(-0.02, 0.02))
    """
    problems = list[str]()
    listed = (names,) if isinstance(names, str) else tuple(names) if isinstance(names, Sequence) else ()
    if not listed or not all(isinstance(one, str) for one in listed):
        problems.append(f"names is {quote(names)}: give names such as ['F1.gain', 'F2.gain']")
    if (factor is None) == (shift is None):
        problems.append("give either factor=(low, high) or shift=(low, high)")
    kind, given = (FACTOR, factor) if factor is not None else (SHIFT, shift)
    ends = pair(given, "1")
    if given is not None and ends is None:
        problems.append(f"{kind} is {quote(given)}: give (low, high), the lower one first")
    if kind == FACTOR and ends is not None and ends[0] <= 0.0:
        problems.append(f"factor is {quote(given)}: both must be > 0")
    if problems or ends is None:
        raise UseError("together", problems)
    return Together(listed, kind, *ends)
