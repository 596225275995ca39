"""How a run is done: tolerances, method, budgets and what is written down."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from clutchwork.errors import near

Method = Literal["rodas5p", "dopri5", "auto"]
METHODS: dict[str, int] = {"auto": 0, "rodas5p": 1, "dopri5": 2}
OUTPUTS = ("smooth", "steps")

# A grid finer than this does not fit into memory together with its signals.
MOST_ROWS = 100_000_000


@dataclass(frozen=True)
class Options:
    """Options of a run; every one may also be given to `simulate` by name.

    Output: `times` gives exactly these instants, `dt` a uniform grid that ends with t_end. Without
    either, `output` decides: "smooth" gives the solver's steps refined to `points` intervals, with the left
    and the right limit at every event; "steps" gives the bare steps of the solver.

    Use "rodas5p" unless the model has no stiff part; "dopri5" saves time on soft models; "auto" chooses per
    smooth phase.
    """

    rtol: float = 1e-6  # relative tolerance of speeds and states
    atol: float = 1e-8  # absolute tolerance, in the unit of each quantity
    method: Method = "rodas5p"
    first_step: float | None = None  # s; None: chosen by the solver
    max_step: float | None = None  # s; None: no limit
    max_steps: int = 10_000_000  # budget of the whole run
    max_events: int = 100_000  # budget of the whole run
    dt: float | None = None  # s, spacing of the output
    times: Sequence[float] | NDArray[np.float64] | None = None  # s, instants of the output
    output: str = "smooth"  # when neither dt nor times is given
    points: int = 1000  # intervals that "smooth" output has at least
    angles: bool = True  # integrate the angles of all shafts
    work: bool = True  # integrate the work of all elements, for the energy balance

    def __post_init__(self) -> None:
        """Refuse values that make no sense, with what to write instead."""
        for name in ("rtol", "atol"):
            _positive(name, getattr(self, name), "")
        for name in ("first_step", "max_step", "dt"):
            if getattr(self, name) is not None:
                _positive(name, getattr(self, name), " s")
        for name in ("max_steps", "max_events", "points"):
            if getattr(self, name) < 1:
                raise ValueError(f"{name} is {getattr(self, name)}: it must be at least 1")
        if self.rtol < 1e-14:
            raise ValueError(f"rtol is {self.rtol:g}: double precision carries no more than 1e-14")
        _one_of("method", self.method, tuple(METHODS))
        _one_of("output", self.output, OUTPUTS)
        if self.dt is not None and self.times is not None:
            raise ValueError("dt and times are both given: give the spacing or the instants, not both")

    def changed(self, changes: dict[str, Any]) -> Options:
        """These options with some replaced; an unknown name raises TypeError with a near match."""
        known = [item.name for item in fields(self)]
        for name in changes:
            if name not in known:
                raise TypeError(f"simulate has no option {name!r}{near(name, known)}; options are {', '.join(known)}")
        return replace(self, **changes)

    def grid(self, t_end: float) -> NDArray[np.float64] | None:
        """The wanted output instants [s], or None when the solver's steps decide."""
        if self.dt is not None:
            return _uniform(self.dt, t_end)
        return None if self.times is None else _given(self.times, t_end)

    def core_options(self) -> dict[str, float]:
        """The options that the compiled core knows, as its numbers."""
        return {
            "rtol": self.rtol,
            "atol": self.atol,
            "method": float(METHODS[self.method]),
            "first_step": self.first_step or 0.0,
            "max_step": math.inf if self.max_step is None else self.max_step,
            "max_steps": float(self.max_steps),
            "max_events": float(self.max_events),
            "angles": float(self.angles),
            "work": float(self.work),
        }


def end_time(t_end: float) -> float:
    """Check the end time of a run [s]."""
    return _positive("t_end", t_end, " s")


def _positive(name: str, value: float, unit: str) -> float:
    number = float(value)
    if not (math.isfinite(number) and number > 0.0):
        raise ValueError(f"{name} is {number:g}{unit}: it must be a finite number above 0")
    return number


def _one_of(name: str, value: str, known: Sequence[str]) -> None:
    if value not in known:
        raise ValueError(f"{name} is {value!r}{near(str(value), known)}; it may be {', '.join(known)}")


def _uniform(dt: float, t_end: float) -> NDArray[np.float64]:
    """0, dt, 2 dt ... and t_end; a last interval that is only round-off long is dropped."""
    count = math.floor(t_end / dt * (1.0 + 1e-12))
    if count > MOST_ROWS:
        raise ValueError(f"dt is {dt:g} s: {count} instants up to {t_end:g} s do not fit into memory; take a larger dt")
    grid: NDArray[np.float64] = np.minimum(np.arange(count + 1) * dt, t_end)
    if t_end - grid[-1] > 1e-9 * dt:
        return np.append(grid, t_end)
    grid[-1] = t_end
    return grid


def _given(times: Sequence[float] | NDArray[np.float64], t_end: float) -> NDArray[np.float64]:
    grid = np.array(times, dtype=float)
    if grid.ndim != 1 or grid.size == 0:
        raise ValueError("times must be a row of at least one instant")
    if not np.all(np.isfinite(grid)) or np.any(np.diff(grid) < 0.0):
        raise ValueError("times must be finite and must not decrease; an instant given twice gets both limits there")
    if grid[0] < 0.0 or grid[-1] > t_end:
        raise ValueError(
            f"times run from {grid[0]:g} to {grid[-1]:g} s: they must lie between 0 and t_end = {t_end:g} s"
        )
    return grid
