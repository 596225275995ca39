"""Pictures of a calibration: signals before and after, and the front of a goal over a limit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.calibration.terms import Jerk, OutputTerm, RmsJerk, SquaredSlope, TableSlope
from clutchwork.plot.compare import compare

if TYPE_CHECKING:
    from clutchwork.calibration.record import CalibrationRecord
    from clutchwork.plot.canvas import Picture

MOST_PANELS = 5


def before_and_after(found: CalibrationRecord, signals: Sequence[Any], path: str | Path | None) -> Picture:
    """Both runs over each other."""
    runs = {"before": found.run_before(), "after": found.run()}
    chosen = list(signals) or usual(found, set(runs["after"].names))
    return compare(runs, *chosen, path=path)


def usual(found: CalibrationRecord, known: set[str]) -> list[str]:
    """Signals that the free numbers, the goal and the limits are about."""
    return list(dict.fromkeys(name for name in _signals(found) if name in known))[:MOST_PANELS]


def _signals(found: CalibrationRecord) -> Iterator[str]:
    problem = found.problem
    for one in problem.unknowns:
        for name in one.numbers:
            yield name.partition(".values[")[0].partition(".times[")[0]
    for what in (problem.goal, *(limit.what for limit in problem.limits)):
        for term, _ in what.terms:
            yield from _of(term)


def _of(term: Any) -> Iterator[str]:
    if isinstance(term, Jerk | RmsJerk):
        yield f"{term.shaft}.acceleration"
    elif isinstance(term, TableSlope | SquaredSlope):
        yield term.stem
    elif isinstance(term, OutputTerm):
        contact = getattr(term.output, "contact", "")
        owner = contact or str(getattr(term.output, "signal", "")).rpartition(".")[0]
        yield from (f"{contact}.slip", f"{contact}.torque") if contact else (str(getattr(term.output, "signal", "")),)
        yield f"{owner}.torque"
