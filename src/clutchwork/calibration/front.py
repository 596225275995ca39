"""The least goal over the bound of a limit: what more heat buys in comfort."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import UseError, columns, dataclass, quote
from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.base.paths import fitting
from clutchwork.base.progress import followed
from clutchwork.calibration.record import CalibrationError, CalibrationRecord
from clutchwork.plot.chosen import PICTURES
from clutchwork.plot.figure import figure_of, written
from clutchwork.plot.style import COLOURS
from clutchwork.sweeps.numbers import number

if TYPE_CHECKING:
    from clutchwork.calibration.limits import Settled
    from clutchwork.plot.canvas import Picture

HEIGHT = 80.0  # mm


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
    calibrations: tuple[CalibrationRecord, ...]

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
        return drawn(self, None if path is None else fitting("front.plot", path, "front.png", PICTURES))


def front(found: CalibrationRecord, limit: Settled, bounds: Sequence[Any], progress: Any) -> Front:
    """Each bound from what the one before led to."""
    ends = [one for one in (number(given, limit.unit) for given in bounds) if one is not None]
    place = next(k for k, one in enumerate(found.problem.limits) if one is limit)
    if isinstance(bounds, str) or not ends or len(ends) < len(bounds) or limit.is_equal:
        raise UseError("front", [f"bounds are {quote(bounds)}: give several numbers for one side of {limit.name}"])
    made, last, above = list[CalibrationRecord](), found, np.isfinite(limit.upper)
    goals, slopes = np.full((2, len(ends)), np.nan)
    with followed(progress, len(ends), "front", "(bounds done, bounds)", unit=" bounds") as told:
        for count, end in enumerate(ends):
            side = replace(limit, upper=float(end)) if above else replace(limit, lower=float(end))
            limits = tuple(side if one is limit else one for one in found.problem.limits)
            try:
                last = found.search(replace(found.problem, limits=limits, begin=last.x), replace(found.asked, starts=1))
                made.append(last)
            except CalibrationError:
                last = found
            else:
                held = last.limits[place]
                slopes[count] = held.by_upper if above else held.by_lower
                goals[count] = last.goal[1] if last.feasible else np.nan
            if told is not None:
                told(count + 1)
    problem = found.problem
    named = (limit.name, limit.unit, problem.goal.name, problem.unit)
    return Front(*named, np.array(ends, dtype=float), goals, slopes, tuple(made))


def drawn(found: Front, path: Path | None) -> Picture:
    """The goal over the bound, with short lines of the slope that the multipliers say."""
    with figure_of(HEIGHT) as figure:
        axes = figure.add_subplot()
        axes.plot(found.bounds, found.goals, "o-", color=COLOURS[0], markersize=3.5)
        reach = 0.3 * float(np.min(np.abs(np.diff(np.sort(found.bounds))), initial=np.inf))
        for x, y, slope in zip(found.bounds, found.goals, found.slopes, strict=True):
            if np.isfinite(reach * y * slope):
                axes.plot(
                    [x - reach, x + reach], [y - reach * slope, y + reach * slope], color=COLOURS[1], linewidth=1.2
                )
        axes.set_xlabel(f"{found.limit} allowed, {found.limit_unit}")
        axes.set_ylabel(f"{found.goal}{f', {found.goal_unit}' if found.goal_unit else ''}")
    return written(figure, path)
