"""Limits that are linear in the unknowns, such as slopes of a pressure: they need no run, and solvers take them so."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.calibration.moves import Moves
from clutchwork.calibration.rows import Row, rows_of, size_of
from clutchwork.calibration.terms import SquaredSlope, TermData
from clutchwork.calibration.together import VALUE

if TYPE_CHECKING:
    from clutchwork.calibration.limits import Settled
    from clutchwork.calibration.problem import CalibrationProblem


def is_linear_table(problem: CalibrationProblem, stem: str) -> bool:
    """Whether slopes of a table depend linearly on the unknowns: its times stay, its values are free one by one."""
    times = {one.name for one in problem.curves[stem].times}
    values = {one.name for one in problem.curves[stem].values}
    return not any(
        times.intersection(one.numbers) or (one.kind != VALUE and values.intersection(one.numbers))
        for one in problem.unknowns
    )


def is_linear(problem: CalibrationProblem, limit: Settled) -> bool:
    """Whether a limit is linear in the unknowns, the same in all samples of production."""
    what = limit.what
    scattered = {name for one in problem.scatter for name in one.numbers}
    for stem in what.tables:
        if scattered.intersection(one.name for one in (*problem.curves[stem].times, *problem.curves[stem].values)):
            return False
    plain = not what.needs_run and not any(isinstance(one, SquaredSlope) for one, _ in what.terms)
    return plain and all(is_linear_table(problem, stem) for stem in what.tables)


def without_run(problem: CalibrationProblem) -> TermData:
    """What terms that need no run are computed from, at the start."""
    moves = Moves(problem.unknowns, problem.numbers)
    numbers = moves.apply(problem.base, problem.start)
    places = {name: at for at, name in enumerate(problem.numbers)}
    return TermData(np.zeros(0), np.zeros((0, len(numbers))), numbers, places, problem.curves, problem.span)


class LinearLimits:
    """All linear limits: A y <= b over unknowns that go from 0 to 1 between their bounds."""

    def __init__(self, problem: CalibrationProblem) -> None:
        self.problem = problem
        self.width = problem.high - problem.low
        self.numbers = [number for number, limit in enumerate(problem.limits) if is_linear(problem, limit)]
        rows, lines, ends = list[Row](), list[Array](), list[float]()
        y = (problem.start - problem.low) / self.width
        by_y = Moves(problem.unknowns, problem.numbers).slopes(problem.base, problem.start) * self.width
        for number in self.numbers:
            limit = problem.limits[number]
            values, slopes = limit.what.rows(without_run(problem))
            slopes = slopes @ by_y
            for one in rows_of(limit, number, slice(0, len(values)), size_of(limit) or 1.0):
                for sign in (1.0, -1.0) if one.sign == 0.0 else (one.sign,):
                    line = sign * slopes[one.row] / one.scale
                    rows.append(one._replace(sign=sign))
                    lines.append(line)
                    ends.append(sign * (one.bound - float(values[one.row])) / one.scale + float(line @ y))
        self.rows = tuple(rows)
        self.matrix, self.ends = np.array(lines).reshape(len(rows), len(y)), np.array(ends)

    def nearest(self, x: Array) -> Array:
        """The nearest unknowns that hold these limits, distances in shares of their bounds."""
        y = (x - self.problem.low) / self.width
        if not self.rows or np.all(self.matrix @ y <= self.ends):
            return x
        unit = np.eye(len(y))
        lines = np.vstack([self.matrix, unit, -unit])
        room = np.concatenate([self.ends - self.matrix @ y, 1.0 - y, y])
        # C. L. Lawson, R. J. Hanson, Solving least squares problems, 1974, chapter 23: the least distance
        dual, target = np.vstack([-lines.T, -room]), np.append(np.zeros(len(y)), 1.0)
        factors, _ = need("scipy.optimize", "calibrate", "calibrate").nnls(dual, target)
        left = dual @ factors - target
        if abs(left[-1]) < 1e-12:
            return x
        made: Array = self.problem.low + np.clip(y - left[:-1] / left[-1], 0.0, 1.0) * self.width
        return made
