"""Sequential quadratic programming, SLSQP of SciPy, on unknowns in which the known curvature is the same everywhere.

D. Kraft, A software package for sequential quadratic programming, DFVLR-FB 88-28, 1988.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.calibration.ending import Ending, SearchEnded
from clutchwork.calibration.rows import ConstraintBlock, Row
from clutchwork.calibration.scaled import Scaled


def slsqp(scaled: Scaled, ending: Ending, iterations: int) -> Array:
    """The scaled unknowns where the search ended."""
    optimize = need("scipy.optimize", "calibrate", "calibrate")
    start, count = scaled.start, scaled.count
    by_z = whitened(scaled)
    matrix, ends = scaled.linear
    rows = _within(scaled)
    blocks = [ConstraintBlock([one for one in rows if (one.sign == 0.0) == equal]) for equal in (True, False)]

    def to_y(z: Array) -> Array:
        made: Array = start + by_z @ z
        return made

    constraints: list[dict[str, Any]] = [
        {
            "type": kind,
            "fun": lambda z, block=block: scaled.values(to_y(z), block),
            "jac": lambda z, block=block: scaled.slopes(to_y(z), block) @ by_z,
        }
        for kind, block in zip(("eq", "ineq"), blocks, strict=True)
        if block.rows
    ]
    own, (low, high) = len(scaled.width), scaled.box
    plain = np.count_nonzero(by_z - np.diag(np.diag(by_z))) == 0
    box: Any = None
    if plain:
        scale = np.diag(by_z)[:own]
        box = [*zip(low / scale, high / scale, strict=True), *[(None, None)] * (count - own)]
    else:
        unit = np.eye(count)[:own]
        matrix = np.vstack([matrix, unit, -unit])
        ends = np.concatenate([ends, start[:own] + high, -start[:own] - low])
    if len(ends):
        lines, room = -matrix @ by_z, ends - matrix @ start
        constraints.append({"type": "ineq", "fun": lambda z: room + lines @ z, "jac": lambda _: lines})
    with suppress(SearchEnded):
        optimize.minimize(
            lambda z: scaled.goal(to_y(z)),
            np.zeros(count),
            jac=lambda z: scaled.gradient(to_y(z)) @ by_z,
            bounds=box,
            constraints=constraints,
            method="SLSQP",
            callback=lambda z: ending.look(to_y(z)),
            # it ends by what is left of the gradient
            options={"ftol": 1e-18, "maxiter": iterations},
        )
    return ending.best


def _within(scaled: Scaled) -> list[Row]:
    """Rows that matter within the box, with as much again for what gradients change: thousands take long."""
    if scaled.curvature is not None:
        return scaled.rows
    block, y = ConstraintBlock(scaled.rows), scaled.start
    near = scaled.within(block, scaled.values(y, block), scaled.slopes(y, block), 2.0 * scaled.reach)
    return [one for one, matters in zip(block.rows, near, strict=True) if matters]


def whitened(scaled: Scaled) -> Array:
    """Scaled unknowns by those of the solver, in which the first guess of the curvature is one."""
    # docs/theory/calibration.md (2)
    size = scaled.steepest / scaled.reach or 1.0
    if scaled.curvature is None:
        made = np.full(scaled.count, 1.0 / np.sqrt(size))
        # the bound of several values has no curvature of its own
        made[len(scaled.width) :] = 10.0
        return np.diag(made)
    known = scaled.curvature
    touched = np.diag(known) > 0.0
    more = np.where(touched, 1e-9 * np.max(np.diag(known)), size)
    lower = np.linalg.cholesky(known + np.diag(more))
    inverse: Array = np.linalg.inv(lower).T
    return inverse
