"""The interior point method IPOPT, by cyipopt.

A. Wächter, L. T. Biegler, On the implementation of an interior-point filter line-search algorithm for large-scale
nonlinear programming, doi:10.1007/s10107-004-0559-y.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.extras import need
from clutchwork.calibration.ending import Ending
from clutchwork.calibration.rows import ConstraintBlock
from clutchwork.calibration.scaled import REFUSED, Scaled
from clutchwork.calibration.slsqp import whitened

Array = NDArray[np.float64]
UNBOUNDED = 1e20


class _Functions:
    """What cyipopt calls."""

    def __init__(self, scaled: Scaled, by_z: Array) -> None:
        self.scaled, self.by_z, self.block = scaled, by_z, ConstraintBlock(scaled.rows)
        own = len(scaled.width)
        matrix, ends = scaled.linear
        self.lines = np.vstack([matrix, np.eye(scaled.count)[:own]]) @ by_z
        self.room = np.concatenate([ends - matrix @ scaled.start, 1.0 - scaled.start[:own]])
        least = np.concatenate([np.full(len(ends), -UNBOUNDED), -scaled.start[:own]])
        equal = np.array([one.sign == 0.0 for one in self.block.rows], dtype=bool)
        self.least = np.concatenate([np.zeros(len(equal)), least])
        self.most = np.concatenate([np.where(equal, 0.0, UNBOUNDED), self.room])

    def to_y(self, z: Array) -> Array:
        made: Array = self.scaled.start + self.by_z @ z
        return made

    def objective(self, z: Array) -> float:
        value = self.scaled.goal(self.to_y(z))
        # what is not a number makes it go back
        return float("nan") if value >= REFUSED else value

    def gradient(self, z: Array) -> Array:
        made: Array = self.scaled.gradient(self.to_y(z)) @ self.by_z
        return made

    def constraints(self, z: Array) -> Array:
        return np.concatenate([self.scaled.values(self.to_y(z), self.block), self.lines @ z])

    def jacobian(self, z: Array) -> Array:
        return np.vstack([self.scaled.slopes(self.to_y(z), self.block) @ self.by_z, self.lines]).ravel()


def ipopt(scaled: Scaled, ending: Ending, iterations: int) -> Array:
    """The scaled unknowns where the search ended."""
    cyipopt = need("cyipopt", "ipopt", "solver='ipopt'")
    functions = _Functions(scaled, whitened(scaled))
    free = np.full(scaled.count, UNBOUNDED)
    task = cyipopt.Problem(
        n=scaled.count, m=len(functions.least), problem_obj=functions,
        lb=-free, ub=free, cl=functions.least, cu=functions.most,
    )  # fmt: skip
    settings = {
        "hessian_approximation": "limited-memory",
        "max_iter": iterations,
        "tol": float(np.sqrt(ending.tolerance)),
        "print_level": 0,
        "sb": "yes",
        "nlp_scaling_method": "none",
    }
    for name, value in settings.items():
        task.add_option(name, value)
    found, _ = task.solve(np.zeros(scaled.count))
    return functions.to_y(found)
