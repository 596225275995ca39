"""The trust region method of SciPy, `trust-constr`: slower for each step, and calm where curvatures differ much.

R. H. Byrd, M. E. Hribar, J. Nocedal, An interior point algorithm for large-scale nonlinear programming,
doi:10.1137/S1052623497325107.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.extras import need
from clutchwork.calibration.ending import Ending
from clutchwork.calibration.rows import ConstraintBlock
from clutchwork.calibration.scaled import Scaled
from clutchwork.calibration.slsqp import whitened

Array = NDArray[np.float64]


def trust_constr(scaled: Scaled, ending: Ending, iterations: int) -> Array:
    """The scaled unknowns where the search ended."""
    optimize = need("scipy.optimize", "calibrate", "calibrate")
    start, by_z = scaled.start, whitened(scaled)
    own = len(scaled.width)
    matrix, ends = scaled.linear
    block = ConstraintBlock(scaled.rows)

    def to_y(z: Array) -> Array:
        made: Array = start + by_z @ z
        return made

    unit = np.eye(scaled.count)[:own]
    lines, most = np.vstack([matrix, unit]) @ by_z, np.concatenate([ends - matrix @ start, 1.0 - start[:own]])
    least = np.concatenate([np.full(len(ends), -np.inf), -start[:own]])
    limits: list[Any] = [optimize.LinearConstraint(lines, least, most)]
    if block.rows:
        upper = np.array([0.0 if one.sign == 0.0 else np.inf for one in block.rows])
        limits.append(
            optimize.NonlinearConstraint(
                lambda z: scaled.values(to_y(z), block),
                np.zeros(len(upper)),
                upper,
                jac=lambda z: scaled.slopes(to_y(z), block) @ by_z,
                hess=optimize.BFGS(),
            )
        )
    with warnings.catch_warnings():
        # of goals that are linear, and of limits that depend on each other: both are as they should be
        warnings.simplefilter("ignore", UserWarning)
        found = optimize.minimize(
            lambda z: scaled.goal(to_y(z)),
            np.zeros(scaled.count),
            jac=lambda z: scaled.gradient(to_y(z)) @ by_z,
            hess=optimize.BFGS(),
            constraints=limits,
            method="trust-constr",
            options={
                "gtol": 1e-4 * ending.tolerance,
                "xtol": 10.0 * ending.tolerance,
                "barrier_tol": 10.0 * ending.tolerance,
                "maxiter": iterations,
            },
        )
    return to_y(found.x)
