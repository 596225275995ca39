"""A switched system by SciPy: a smooth slope in each mode, and guards that lead to the next as they fall to zero."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

Guard = Callable[[float, np.ndarray], float]


@dataclass(frozen=True)
class Mode:
    """One smooth piece: slope(t, y), and guards with the name of the mode that each leads to."""

    slope: Callable[[float, np.ndarray], Any]
    exits: tuple[tuple[Guard, str], ...] = ()


@dataclass(frozen=True)
class Course:
    """States at the wanted times, and the instants at which a mode began."""

    values: np.ndarray
    changes: tuple[tuple[float, str], ...]


def solve(modes: Mapping[str, Mode], mode: str, y: Any, times: np.ndarray, rtol: float = 1e-11) -> Course:
    """From the first to the last of the times; the guards that have just been passed must leave zero by themselves."""
    t, end, y = float(times[0]), float(times[-1]), np.asarray(y, dtype=float)
    values, changes = np.full((len(times), len(y)), np.nan), [(t, mode)]
    while True:
        here = modes[mode]
        events = [_falling(guard, t) for guard, _ in here.exits]
        found = solve_ivp(
            here.slope,
            (t, end),
            y,
            events=events or None,
            dense_output=True,
            rtol=rtol,
            atol=1e-3 * rtol,
            method="DOP853",
        )
        assert found.success, found.message
        stop = float(found.t[-1])
        inside = (times >= t) & (times <= stop)
        values[inside] = found.sol(times[inside]).T if inside.any() else 0.0
        if found.status == 0:
            return Course(values, tuple(changes))
        which = next(k for k, hits in enumerate(found.t_events) if len(hits))
        mode, t, y = here.exits[which][1], stop, found.y[:, -1]
        changes.append((t, mode))


def _falling(guard: Guard, since: float) -> Guard:
    """A guard that ends its mode; not where it was passed just now."""

    def event(t: float, y: np.ndarray) -> float:
        return guard(t, y) if t > since + 1e-9 else max(guard(t, y), 1e-300)

    event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
    return event
