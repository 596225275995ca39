"""How a run that cannot go on is reported: what, where, when, and what to do about it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from clutchwork.errors import ClutchworkError
from clutchwork.layout import STATUS

if TYPE_CHECKING:
    from clutchwork.trajectory import Trajectory

NAMES = [name for name, *_ in STATUS]
DONE, ROWS_FULL, EVENTS_FULL = (NAMES.index(name) for name in ("done", "rows_full", "events_full"))


class SimulationError(ClutchworkError, RuntimeError):
    """A run failed; `trajectory` holds what was computed before."""

    def __init__(self, message: str, trajectory: Trajectory | None = None) -> None:
        super().__init__(message)
        self.trajectory = trajectory


class StoppedEarly(RuntimeWarning):
    """Warning that a run ended before its end time; `trajectory` holds what was computed."""

    def __init__(self, message: str, trajectory: Trajectory) -> None:
        super().__init__(message)
        self.trajectory = trajectory


def explain(status: int, element: str, time: float, value: float) -> str:
    """One line for a status of the core: message, element, value, time, remedy."""
    _, message, remedy = STATUS[status]
    where = f" at {element!r}" if element else ""
    seen = f" (value {value:g})" if element else ""
    return f"stopped at {time:.9g} s: {message}{where}{seen}: {remedy}"
