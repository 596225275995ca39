"""The least goal over the bound of a limit: what more heat buys in comfort."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import UseError
from clutchwork.base.extras import need
from clutchwork.base.paths import target
from clutchwork.base.progress import followed
from clutchwork.base.shown import shown
from clutchwork.base.text import columns
from clutchwork.calibrate.numbers import number
from clutchwork.results.plot.chosen import PICTURES

if TYPE_CHECKING:
    from clutchwork.calibrate.limits import Settled
    from clutchwork.calibrate.result import Calibration
    from clutchwork.results.plot.canvas import Picture

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Front:
    """The least goal for each bound of a limit."""

    limit: str
    limit_unit: str
    goal: str
    goal_unit: str
    bounds: Array
    goals: Array  # NaN where the limits cannot be held
    slopes: Array  # of the goal over the bound, from the multipliers
    calibrations: tuple[Calibration, ...]

    def to_pandas(self) -> Any:
        """A pandas DataFrame with one line for each bound. Needs pandas."""
        frame = need("pandas", "tables", "a table").DataFrame({self.limit: self.bounds, self.goal: self.goals})
        frame.attrs["units"] = {self.limit: self.limit_unit, self.goal: self.goal_unit}
        return frame

    def __str__(self) -> str:
        head = [f"{self.limit} [{self.limit_unit}]", f"{self.goal} [{self.goal_unit}]"]
        lines = [[f"{x:.6g}", f"{y:.6g}"] for x, y in zip(self.bounds, self.goals, strict=True)]
        return columns([head, *lines], right=(0, 1))

    def plot(self, path: str | Path | None = None) -> Picture:
        """Draw it, with the slope at each point; written to `path` when given. Needs matplotlib."""
        from clutchwork.calibrate.picture import front

        return front(self, None if path is None else target("front.plot", path, "front.png", PICTURES))


def front(found: Calibration, limit: Settled, bounds: Sequence[Any], progress: Any) -> Front:
    """Each bound from what the one before led to."""
    from clutchwork.calibrate.calibrate import searched
    from clutchwork.calibrate.result import CalibrationError, with_limit

    ends = [number(one, limit.unit) for one in bounds] if not isinstance(bounds, str) else []
    if not ends or None in ends or limit.is_equal:
        raise UseError("front", [f"bounds are {shown(bounds)}: give several numbers for one side of {limit.name}"])
    made, last = list["Calibration"](), found
    with followed(progress, len(ends), "front", "(bounds done, bounds)", unit=" bounds") as told:
        for place, end in enumerate(ends):
            side = {"upper": end} if np.isfinite(limit.upper) else {"lower": end}
            moved = with_limit(found.problem, limit, replace(limit, **side))
            try:
                last = searched(replace(moved, begin=last.x), replace(found.asked, starts=1), None, False)
                made.append(last)
            except CalibrationError:
                last = found
            if told is not None:
                told(place + 1)
    goals = np.array([one.goal[1] if one.feasible else np.nan for one in made])
    slopes = np.array([-next(held.multiplier for held in one.limits if held.name == limit.name) for one in made])
    problem = found.problem
    named = (limit.name, limit.unit, problem.goal.name, problem.unit)
    return Front(*named, np.array(ends, dtype=float), goals, slopes, tuple(made))
